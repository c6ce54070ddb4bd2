#include "uart.h"

#include <avr/interrupt.h>
#include <util/atomic.h>

#include "board.h"
#include "config.h"
#include "steps.h"

#if defined(USART0_RX_vect)
#define RECEIVED USART0_RX_vect
#define EMPTY USART0_UDRE_vect
#define SENT USART0_TX_vect
#else
#define RECEIVED USART_RX_vect
#define EMPTY USART_UDRE_vect
#define SENT USART_TX_vect
#endif

namespace uart {

uint8_t buffer[LONGEST];

namespace {

constexpr uint16_t QUIET = steps::TICKS_PER_MS * 7 / 4;
volatile uint16_t length;
volatile uint16_t next;     // the byte to send
volatile uint16_t last_at;  // ticks of timer 1
volatile bool broken;       // too long, or a byte with an error
volatile bool sending;

}  // namespace

void begin() {
    UCSR0A = _BV(U2X0);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    const uint16_t divisor = (F_CPU / 4 / config::BAUD - 1) / 2;
    UBRR0H = divisor >> 8;
    UBRR0L = divisor;
    UCSR0B = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0);
}

uint16_t received() {
    uint16_t complete = 0;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
        if (!sending && length > 0 && static_cast<uint16_t>(TCNT1 - last_at) >= QUIET) {
            complete = broken ? 0 : length;
            if (broken) length = 0;
            broken = false;
        }
    }
    return complete;
}

void forget() {
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { length = 0; }
}

void send(uint16_t count) {
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
        length = count;
        next = 0;
        sending = true;
        board::DRIVER_ENABLE.set(true);
        UCSR0B |= _BV(UDRIE0) | _BV(TXCIE0);
    }
}

}  // namespace uart

ISR(RECEIVED) {
    using namespace uart;
    const bool bad = UCSR0A & (_BV(FE0) | _BV(DOR0));
    const uint8_t byte = UDR0;
    if (sending) return;
    last_at = TCNT1;
    if (bad || length >= LONGEST) broken = true;
    if (length < LONGEST) {
        buffer[length] = byte;
        length = length + 1;
    }
}

ISR(EMPTY) {
    using namespace uart;
    UDR0 = buffer[next];
    next = next + 1;
    if (next >= length) UCSR0B &= ~_BV(UDRIE0);
}

ISR(SENT) {
    using namespace uart;
    if (next < length) return;
    UCSR0B &= ~_BV(TXCIE0);
    board::DRIVER_ENABLE.set(false);
    length = 0;
    sending = false;
}
