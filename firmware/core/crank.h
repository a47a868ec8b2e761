/* The kernel's kinematics of a crank leg (kernel/crank.h), in float. */
#pragma once
#define KERNEL_FLOAT
#include "../../kernel/crank.h"
