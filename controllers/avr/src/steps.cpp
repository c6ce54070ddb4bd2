#include "steps.h"

#include <avr/interrupt.h>
#include <util/atomic.h>

#include "board.h"
#include "config.h"

namespace steps {
namespace {

constexpr uint16_t SOON = 16;  // ticks; enough to leave the interrupt

struct Output {
    Window current;
    Window waiting;
    int32_t position;
    bool rising;  // the next compare match raises the pin
    bool forward;
};
Output outputs[2];

template <uint8_t AXIS>
struct Compare;

template <>
struct Compare<0> {
    static uint16_t now() { return TCNT1; }
    static void at(uint16_t instant) { OCR1A = instant; TIFR1 = _BV(OCF1A); }
    static void toggles() { TCCR1A |= _BV(COM1A0); }
    static void leaves() { TCCR1A &= ~_BV(COM1A0); }  // low by its port
    static void on() { TIMSK1 |= _BV(OCIE1A); }
    static void off() { TIMSK1 &= ~_BV(OCIE1A); }
    static bool is_on() { return TIMSK1 & _BV(OCIE1A); }
};

#if defined(TCNT3)
template <>
struct Compare<1> {
    static uint16_t now() { return TCNT3; }
    static void at(uint16_t instant) { OCR3A = instant; TIFR3 = _BV(OCF3A); }
    static void toggles() { TCCR3A |= _BV(COM3A0); }
    static void leaves() { TCCR3A &= ~_BV(COM3A0); }  // low by its port
    static void on() { TIMSK3 |= _BV(OCIE3A); }
    static void off() { TIMSK3 &= ~_BV(OCIE3A); }
    static bool is_on() { return TIMSK3 & _BV(OCIE3A); }
};
#define SECOND_VECTOR TIMER3_COMPA_vect
#else
template <>
struct Compare<1> {
    static uint16_t now() { return TCNT1; }
    static void at(uint16_t instant) { OCR1B = instant; TIFR1 = _BV(OCF1B); }
    static void toggles() { TCCR1A |= _BV(COM1B0); }
    static void leaves() { TCCR1A &= ~_BV(COM1B0); }  // low by its port
    static void on() { TIMSK1 |= _BV(OCIE1B); }
    static void off() { TIMSK1 &= ~_BV(OCIE1B); }
    static bool is_on() { return TIMSK1 & _BV(OCIE1B); }
};
#define SECOND_VECTOR TIMER1_COMPB_vect
#endif

// Arm the next step, or rest until the next window.
template <uint8_t AXIS>
void arm() {
    Output& output = outputs[AXIS];
    Compare<AXIS>::leaves();
    if (output.current.count == 0) {
        output.current = output.waiting;
        output.waiting.count = 0;
    }
    if (output.current.count == 0) {
        Compare<AXIS>::off();
        return;
    }
    uint16_t lead = SOON;
    if (output.forward != output.current.forward) {
        output.forward = output.current.forward;
        board::DIRECTION[AXIS].set(output.forward);
        lead = config::DIRECTION_TICKS;
    }
    uint16_t instant = output.current.first;
    output.current.first += output.current.interval;
    output.current.count--;
    const uint16_t soonest = Compare<AXIS>::now() + lead;
    if (static_cast<int16_t>(instant - soonest) < 0) instant = soonest;
    output.rising = true;
    Compare<AXIS>::at(instant);
    Compare<AXIS>::toggles();
    Compare<AXIS>::on();
}

template <uint8_t AXIS>
void matched() {
    Output& output = outputs[AXIS];
    if (!output.rising) {
        arm<AXIS>();
        return;
    }
    output.position += output.forward ? 1 : -1;
    output.rising = false;
    Compare<AXIS>::at(Compare<AXIS>::now() + config::PULSE_TICKS);
}

}  // namespace

void begin() {
    for (uint8_t axis = 0; axis < 2; axis++) board::DIRECTION[axis].set(outputs[axis].forward);
#if defined(TCNT3)
    GTCCR = _BV(TSM) | _BV(PSRSYNC);  // both timers start together
    TCCR3B = _BV(CS31);
#endif
    TCCR1B = _BV(CS11);
    GTCCR = 0;
}

uint16_t now() {
    uint16_t ticks;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { ticks = TCNT1; }
    return ticks;
}

bool is_full(uint8_t axis) {
    return const_cast<volatile uint8_t&>(outputs[axis].waiting.count) != 0;
}

void add(uint8_t axis, const Window& window) {
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
        outputs[axis].waiting = window;
        if (axis == 0 && !Compare<0>::is_on()) arm<0>();
        if (axis == 1 && !Compare<1>::is_on()) arm<1>();
    }
}

void drop(uint8_t axis) {
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
        outputs[axis].waiting.count = 0;
        outputs[axis].current.count = 0;
    }
}

int32_t position(uint8_t axis) {
    int32_t steps;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { steps = outputs[axis].position; }
    return steps;
}

void set_position(uint8_t axis, int32_t steps) {
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { outputs[axis].position = steps; }
}

}  // namespace steps

ISR(TIMER1_COMPA_vect) { steps::matched<0>(); }
ISR(SECOND_VECTOR) { steps::matched<1>(); }
