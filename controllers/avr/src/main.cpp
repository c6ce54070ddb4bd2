// Firmware of the two axes: everything that moves happens in interrupts, the loop only talks.
#include <avr/eeprom.h>
#include <avr/interrupt.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "board.h"
#include "machine.h"
#include "map.h"
#include "modbus.h"
#include "steps.h"
#include "uart.h"

namespace {

constexpr uint16_t ERASED = 0xFFFF;
constexpr uint16_t AHEAD = steps::TICKS_PER_MS * 8 / 10;  // steps are planned this long before they are sent
uint16_t boots EEMEM;
uint8_t reset_cause __attribute__((section(".noinit")));
Machine machine;
Map map(machine);
constexpr int16_t HALF_MS = steps::TICKS_PER_MS / 2;
uint16_t planned_from;
volatile bool ticked;

uint16_t count_boot() {
    const uint16_t stored = eeprom_read_word(&boots);
    const uint16_t count = stored >= ERASED - 1 ? 1 : stored + 1;
    eeprom_update_word(&boots, count);
    return count;
}

void begin() {
    board::begin();
    wdt_enable(WDTO_250MS);
    machine.begin(count_boot(), reset_cause & _BV(WDRF) ? HARDWARE_WATCHDOG : NO_FAULT);
    steps::begin();
    uart::begin();
    TCCR2A = _BV(WGM21);
    TCCR2B = _BV(CS22);
    OCR2A = F_CPU / 64 / 1000 - 1;
    TIMSK2 = _BV(OCIE2A);
    planned_from = steps::now() + AHEAD;
    set_sleep_mode(SLEEP_MODE_IDLE);
    sei();
}

}  // namespace

// A watchdog reset leaves the watchdog on: switch it off before anything else.
extern "C" void after_reset() __attribute__((naked, used, section(".init3")));
void after_reset() {
    reset_cause = MCUSR;
    MCUSR = 0;
    wdt_disable();
}

ISR(TIMER2_COMPA_vect, ISR_NOBLOCK) {
    TIMSK2 = 0;  // never inside itself
    do {  // again if a long reply has cost a millisecond
        machine.tick(planned_from);
        planned_from += steps::TICKS_PER_MS;
    } while (static_cast<int16_t>(planned_from - steps::now() - AHEAD) < HALF_MS);
    ticked = true;
    TIMSK2 = _BV(OCIE2A);
}

int main() {
    begin();
    for (;;) {
        sleep_mode();
        if (ticked) {
            ticked = false;
            wdt_reset();
        }
        const uint16_t length = uart::received();
        if (length == 0) continue;
        const uint16_t count = answer(map, uart::buffer, length);
        if (count > 0) uart::send(count);
        else uart::forget();
    }
}
