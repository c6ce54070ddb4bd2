// The serial line: bytes come and go by interrupts, a frame ends with 1.75 ms of silence.
#pragma once
#include <stdint.h>

namespace uart {

constexpr uint16_t LONGEST = 256;
extern uint8_t buffer[LONGEST];

void begin();
uint16_t received();  // the length of a complete frame in the buffer, or 0
void forget();        // listen for the next frame
void send(uint16_t length);

}  // namespace uart
