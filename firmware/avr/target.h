/* The chip's: one board, whose variables are where the linker puts them, and one machine. */
#pragma once
#include "machine.h"

#define STATE
extern const Machine MACHINE;
