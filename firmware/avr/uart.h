/* The line to the host: USART 0. Its interrupts call link.c. */
#pragma once

void uart_begin(void);
