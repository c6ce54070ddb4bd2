/* Runs the firmware of controllers/avr in simavr: time is the cycles of the processor, nothing sleeps.
 *
 * host ELF EEPROM: prints the path of a pseudo terminal, then answers each line on standard input with one line.
 *   run N            let N cycles pass                            -> cycles
 *   ask HEX          send bytes, wait for the reply               -> hex or -, cycles from last byte to first
 *   put HEX          send bytes, wait for their end alone         -> cycles
 *   input BIT VALUE  hold an input at 0 or 1, or a (as the world) -> ok
 *   world A S L U O  axis A: true steps now, of its switches, half width of the home switch -> ok
 *   counts           -> cycles, then per axis: true steps, pulses, least and greatest interval since mark
 *   edges A          -> cycles of the pulses of an axis since mark
 *   outputs          -> level of port C
 *   mark             begin to measure                             -> ok
 *   reset            power off and on                             -> cycles
 * Bytes that come on the pseudo terminal are sent to the firmware and its reply goes back at once.
 * simavr is GPL-3: this program is for tests and is not shipped. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>
#include <simavr/avr_eeprom.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_irq.h>

#define BYTE_CYCLES 4167 /* ten bits at 38,400 baud */
#define WAIT_CYCLES 1600000
#define EDGES 60000
#define INPUTS 8

typedef struct {
    long position, lower, upper, home;
    unsigned long pulses;
    uint64_t last, least, most;
    int forward, level, count;
    uint64_t edges[EDGES];
} axis_t;

static avr_t *avr;
static avr_irq_t *pins[INPUTS], *rx;
static axis_t axes[2];
static int held[INPUTS], level[INPUTS];
static unsigned char reply[512];
static int reply_length;
static uint64_t first_at, last_at;

static void sleep_cycles(avr_t *a, avr_cycle_count_t how_long) { (void)a; (void)how_long; }

static void drive(int bit, int value) {
    if (level[bit] == value) return;
    level[bit] = value;
    avr_ioport_external_t external = {.name = 'A', .mask = 0xff};
    for (int i = 0; i < INPUTS; i++) external.value |= (level[i] == 1) << i;
    avr_ioctl(avr, AVR_IOCTL_IOPORT_SET_EXTERNAL('A'), &external); /* else the pull-up wins */
    avr_raise_irq(pins[bit], value);
}

static void show(int number) {
    static const int opens[] = {1, 1, 0};
    axis_t *axis = &axes[number];
    int on[3] = {axis->position <= axis->lower, axis->position >= axis->upper,
                 axis->position <= axis->home && axis->position >= -axis->home};
    for (int i = 0; i < 3; i++) {
        int bit = 3 * number + i;
        drive(bit, held[bit] >= 0 ? held[bit] : on[i] == opens[i]);
    }
}

static void show_all(void) {
    show(0);
    show(1);
    drive(6, held[6] >= 0 ? held[6] : 0);
    drive(7, held[7] >= 0 ? held[7] : 1);
}

static void on_step(avr_irq_t *irq, uint32_t value, void *param) {
    axis_t *axis = param;
    int high = value & 1;
    (void)irq;
    if (high == axis->level) return;
    axis->level = high;
    if (!high) return;
    axis->pulses++;
    axis->position += axis->forward ? 1 : -1;
    if (axis->last) {
        uint64_t way = avr->cycle - axis->last;
        if (way < axis->least) axis->least = way;
        if (way > axis->most) axis->most = way;
    }
    axis->last = avr->cycle;
    if (axis->count < EDGES) axis->edges[axis->count++] = avr->cycle;
    show(axis == &axes[1]);
}

static void on_direction(avr_irq_t *irq, uint32_t value, void *param) {
    (void)irq;
    ((axis_t *)param)->forward = value & 1;
}

static void on_byte(avr_irq_t *irq, uint32_t value, void *param) {
    (void)irq;
    (void)param;
    if (reply_length == 0) first_at = avr->cycle;
    last_at = avr->cycle;
    if (reply_length < (int)sizeof reply) reply[reply_length++] = value;
}

static void mark(void) {
    for (int i = 0; i < 2; i++) {
        axes[i].last = axes[i].most = 0;
        axes[i].least = UINT64_MAX;
        axes[i].count = 0;
    }
}

static void run_to(uint64_t end) {
    while (avr->cycle < end) {
        int state = avr_run(avr);
        if (state == cpu_Done || state == cpu_Crashed) {
            fprintf(stderr, "the firmware crashed at cycle %llu\n", (unsigned long long)avr->cycle);
            exit(3);
        }
    }
}

static void put(const unsigned char *bytes, int count) {
    for (int i = 0; i < count; i++) {
        run_to(avr->cycle + BYTE_CYCLES);
        avr_raise_irq(rx, bytes[i]);
    }
}

/* Send bytes and run until the reply has been silent for two bytes, or none came. */
static uint64_t ask(const unsigned char *bytes, int count) {
    put(bytes, count);
    uint64_t sent = avr->cycle;
    reply_length = 0;
    while (reply_length == 0 ? avr->cycle < sent + WAIT_CYCLES : avr->cycle < last_at + 2 * BYTE_CYCLES)
        run_to(avr->cycle + 400);
    return reply_length ? first_at - sent : 0;
}

static int from_hex(const char *hex, unsigned char *bytes) {
    int count = 0;
    unsigned value;
    while (count < 512 && sscanf(hex + 2 * count, "%2x", &value) == 1) bytes[count++] = value;
    return count;
}

static void power_on(void) {
    uint32_t flags = 0;
    avr_ioctl(avr, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
    flags &= ~(AVR_UART_FLAG_STDIO | AVR_UART_FLAG_POLL_SLEEP);
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    for (int i = 0; i < INPUTS; i++) level[i] = -1;
    show_all();
}

static void answer_line(char *line) {
    unsigned char bytes[512];
    char what[16] = "", value[1100] = "";
    int bit;
    long a, s, l, u, o;
    sscanf(line, "%15s %1099s", what, value);
    if (!strcmp(what, "run")) {
        run_to(avr->cycle + strtoull(value, 0, 10));
        printf("%llu\n", (unsigned long long)avr->cycle);
    } else if (!strcmp(what, "put")) {
        put(bytes, from_hex(value, bytes));
        printf("%llu\n", (unsigned long long)avr->cycle);
    } else if (!strcmp(what, "ask")) {
        uint64_t wait = ask(bytes, from_hex(value, bytes));
        for (int i = 0; i < reply_length; i++) printf("%02x", reply[i]);
        printf("%s %llu\n", reply_length ? "" : "-", (unsigned long long)wait);
    } else if (!strcmp(what, "input") && sscanf(line, "%*s %d %15s", &bit, what) == 2) {
        held[bit & 7] = what[0] == 'a' ? -1 : what[0] - '0';
        show_all();
        puts("ok");
    } else if (!strcmp(what, "world") && sscanf(line, "%*s %ld %ld %ld %ld %ld", &a, &s, &l, &u, &o) == 5) {
        axis_t *axis = &axes[a & 1];
        axis->position = s, axis->lower = l, axis->upper = u, axis->home = o;
        show_all();
        puts("ok");
    } else if (!strcmp(what, "counts")) {
        printf("%llu", (unsigned long long)avr->cycle);
        for (int i = 0; i < 2; i++)
            printf(" %ld %lu %llu %llu", axes[i].position, axes[i].pulses, (unsigned long long)axes[i].least,
                   (unsigned long long)axes[i].most);
        puts("");
    } else if (!strcmp(what, "edges")) {
        axis_t *axis = &axes[value[0] - '0'];
        for (int i = 0; i < axis->count; i++) printf("%llu ", (unsigned long long)axis->edges[i]);
        puts("");
    } else if (!strcmp(what, "outputs")) {
        avr_ioport_state_t state;
        avr_ioctl(avr, AVR_IOCTL_IOPORT_GETSTATE('C'), &state);
        printf("%d\n", (int)state.port);
    } else if (!strcmp(what, "mark")) {
        mark();
        puts("ok");
    } else if (!strcmp(what, "reset")) {
        avr_reset(avr);
        power_on();
        printf("%llu\n", (unsigned long long)avr->cycle);
    } else {
        puts("unknown");
    }
    fflush(stdout);
}

static void serve(int terminal) {
    struct pollfd ready[2] = {{0, POLLIN, 0}, {terminal, POLLIN, 0}};
    static char line[2048];
    int filled = 0;
    while (poll(ready, 2, -1) > 0) {
        if (ready[1].revents & POLLIN) {
            unsigned char bytes[512];
            int count = read(terminal, bytes, sizeof bytes);
            if (count > 0) {
                ask(bytes, count);
                if (reply_length && write(terminal, reply, reply_length) < 0) return;
            }
        } else if (ready[0].revents) {
            int count = read(0, line + filled, sizeof line - filled - 1);
            if (count <= 0) return;
            filled += count;
            for (char *end; (end = memchr(line, '\n', filled));) {
                *end = 0;
                answer_line(line);
                filled -= end + 1 - line;
                memmove(line, end + 1, filled);
            }
        }
    }
}

int main(int count, char **words) {
    static const struct { char port; int bit; } steps[] = {{'B', 5}, {'E', 3}};
    elf_firmware_t firmware = {0};
    struct termios raw;
    int terminal, other;
    char name[64];
    if (count != 2 || elf_read_firmware(words[1], &firmware)) return 2;
    avr = avr_make_mcu_by_name("atmega2560");
    if (!avr || openpty(&terminal, &other, name, 0, 0)) return 2;
    tcgetattr(other, &raw);
    cfmakeraw(&raw);
    tcsetattr(other, TCSANOW, &raw);
    avr_init(avr);
    firmware.frequency = 16000000;
    avr_load_firmware(avr, &firmware);
    avr->sleep = sleep_cycles;
    avr->log = LOG_ERROR;
    for (int i = 0; i < INPUTS; i++) {
        held[i] = -1;
        pins[i] = avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('A'), i);
    }
    for (int i = 0; i < 2; i++) {
        axes[i].lower = -100000000, axes[i].upper = 100000000, axes[i].home = -1;
        avr_irq_t *step = avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ(steps[i].port), steps[i].bit);
        avr_irq_register_notify(step, on_step, &axes[i]);
        avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('C'), i), on_direction, &axes[i]);
    }
    rx = avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_byte, 0);
    mark();
    power_on();
    printf("%s\n", name);
    fflush(stdout);
    serve(terminal);
    return 0;
}
