#include "target.h"

#include "parameters.h" /* made from the machine file */

const Machine MACHINE = MACHINE_PARAMETERS;
