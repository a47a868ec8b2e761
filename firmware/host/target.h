/* The computer's: boards take turns with the program's variables, which therefore stand side by
 * side in a section of their own (host.c), and the machine is handed in.
 */
#pragma once
#include "machine.h"

#ifndef STATE
#define STATE __attribute__((section("board_state")))
#endif

/* The machine of the board whose turn it is. */
extern const Machine *host_machine;
#define MACHINE (*host_machine)
