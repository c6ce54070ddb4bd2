// Pins of Arduino Mega 2560 and Arduino Uno.
#pragma once
#include <avr/io.h>
#include <stdint.h>
#include <util/atomic.h>

namespace board {

struct Pin {
    volatile uint8_t* port;
    uint8_t bit;

    void output() const { *(port - 1) |= static_cast<uint8_t>(1 << bit); }
    void set(bool high) const {
        ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
            if (high) *port |= static_cast<uint8_t>(1 << bit);
            else *port &= static_cast<uint8_t>(~(1 << bit));
        }
    }
};

// Bits of `inputs`, in the order of the map's switches.
constexpr uint8_t LOWER = 1, UPPER = 2, HOME = 4, SWITCHES = 0x3F, EMERGENCY = 0x40, LOCAL = 0x80;
// Home switches and the local switch close to ground; limit switches and emergency stop open.
constexpr uint8_t CLOSES = 0xA4;

#if defined(__AVR_ATmega2560__)
static const Pin STEP[2] = {{&PORTB, 5}, {&PORTE, 3}};       // D11, D5
static const Pin DIRECTION[2] = {{&PORTC, 0}, {&PORTC, 1}};  // D37, D36
static const Pin BRAKE[2] = {{&PORTC, 2}, {&PORTC, 3}};      // D35, D34
static const Pin HORN = {&PORTC, 4};                         // D33
static const Pin DRIVER_ENABLE = {&PORTC, 5};                // D32
inline void pull_up() { PORTA = 0xFF; }
inline uint8_t levels() { return PINA; }                     // D22 to D29
#elif defined(__AVR_ATmega328P__)
static const Pin STEP[2] = {{&PORTB, 1}, {&PORTB, 2}};       // D9, D10
static const Pin DIRECTION[2] = {{&PORTD, 4}, {&PORTD, 5}};  // D4, D5
static const Pin BRAKE[2] = {{&PORTD, 6}, {&PORTD, 7}};      // D6, D7
static const Pin HORN = {&PORTB, 0};                         // D8
static const Pin DRIVER_ENABLE = {&PORTB, 3};                // D11
inline void pull_up() { PORTC = 0x3F; PORTD = 0x0C; }
inline uint8_t levels() { return (PINC & 0x3F) | static_cast<uint8_t>((PIND & 0x0C) << 4); }  // A0 to A5, D2, D3
#else
#error "This firmware is for ATmega2560 (Arduino Mega) and ATmega328P (Arduino Uno)."
#endif

inline uint8_t inputs() { return levels() ^ CLOSES; }

inline void begin() {
    pull_up();
    for (uint8_t axis = 0; axis < 2; axis++) {
        STEP[axis].output();
        DIRECTION[axis].output();
        BRAKE[axis].output();
    }
    HORN.output();
    DRIVER_ENABLE.output();
}

}  // namespace board
