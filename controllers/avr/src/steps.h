// Step pulses of both axes, raised by the output compare units of timers 1 and 3, on the Uno of timer 1 (0.5 us a tick).
#pragma once
#include <stdint.h>

namespace steps {

constexpr uint16_t TICKS_PER_MS = 2000;

// The steps of one millisecond: the instant of the first, the ticks between two, how many, which way.
struct Window {
    uint16_t first;
    uint16_t interval;
    uint8_t count;
    bool forward;
};

void begin();
uint16_t now();
bool is_full(uint8_t axis);                      // a window is waiting already
void add(uint8_t axis, const Window& window);    // only if it is not full
void drop(uint8_t axis);                         // no further step; returns after a pulse at most
int32_t position(uint8_t axis);                  // steps sent, from zero
void set_position(uint8_t axis, int32_t steps);  // only at rest

}  // namespace steps
