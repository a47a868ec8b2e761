/* The board's modes: when pulses go out, when they follow the host, when they stand still.
 *
 * Safe states: DISARMED (no pulses: after power-up, reset and DISARM) and, while armed, standing
 * still (STOPPED, FAULT, HOLDING). Only ARMED and HOLDING accept setpoints and programs.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "protocol.h"

typedef struct {
    uint8_t code; /* enum FaultCode; FAULT_NONE: no fault */
    uint8_t joint;
    uint16_t value;
} Fault;

/* Aims at counts that are good for `deadline_ms`, or refuses with a reason and changes nothing. */
Fault safety_follow(uint16_t deadline_ms, const uint16_t *counts, uint8_t joints);

/* Each does what is requested, or refuses with a reason and changes nothing: enum Result. */
uint8_t safety_arm(const uint16_t *park, uint8_t joints);
uint8_t safety_arm_to_play(const uint16_t *start, uint8_t program); /* as soon as armed, in a loop */
uint8_t safety_disarm(void);
uint8_t safety_stop(void);
uint8_t safety_clear(void);
uint8_t safety_play(uint8_t program, bool is_loop);

/* Call after a command of a host was obeyed: what the start button requested is forgotten, and
 * after a claim the machine is the host's from then on, until its deadline passes. */
void safety_note_host(bool is_claim);

/* Deadline and stop button; call in every round of the loop. */
void safety_watch(void);

/* Battery, arming and playing, once a period; the fault that begins now, if one does. */
Fault safety_pass_period(void);

bool safety_is_playing(void);

/* A host was the last to command it, and its deadline has not passed. */
bool safety_is_hosts(void);

uint8_t safety_mode(void);
uint8_t safety_flags(void);
uint8_t safety_fault(void);
