#include "crank.h"

#include "../../kernel/crank.c"
