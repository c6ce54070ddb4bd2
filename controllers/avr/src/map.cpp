#include "map.h"

#include <string.h>

#include "config.h"

namespace {

constexpr uint16_t STATUS_COUNT = 40, CLOCK_FIRST = 50, INPUTS = 32;
enum Address : uint8_t {
    IDENTITY = 0, MAP_VERSION, HEARTBEAT, ECHO, BOOT_COUNT, STATUS, SWITCHES, FAULT_CODE,
    POSITION = 8, VELOCITY = 12, REQUEST_DONE = 16, WATCHDOG = 17, UPTIME = 18, KEEP_ALIVE = 20,
    AZIMUTH = 21, ELEVATION = 26, REQUEST_NUMBER = 31, REQUEST_KIND = 32, STOP = 33, HORN = 38,
};

bool is_clock(uint16_t address) { return address >= CLOCK_FIRST && address < CLOCK_FIRST + WallClock::PARTS; }
bool is_known(uint16_t address) { return address < STATUS_COUNT || is_clock(address); }
bool is_writable(uint16_t address) {
    return (address >= KEEP_ALIVE && address <= STOP) || address == HORN || is_clock(address);
}

}  // namespace

void Map::put(uint8_t address, uint32_t value) {
    words_[address] = value >> 16;
    words_[address + 1] = value;
}

uint32_t Map::pair(uint8_t address) const {
    return static_cast<uint32_t>(words_[address]) << 16 | words_[address + 1];
}

void Map::put_axis(uint8_t address, const AxisCommand& command) {
    words_[address] = static_cast<uint16_t>(command.motion);
    put(address + 1, command.setpoint);
    put(address + 3, command.speed);
}

AxisCommand Map::axis_command(uint8_t address) const {
    const Motion motion = static_cast<Motion>(words_[address]);
    if (motion == Motion::HALT) return {};
    const uint32_t speed = motion == Motion::POSITION ? pair(address + 3) : 0;
    return {motion, static_cast<int32_t>(pair(address + 1)), speed};
}

Command Map::command() const {
    Command command = {{axis_command(AZIMUTH), axis_command(ELEVATION)}, words_[HORN] != 0, 0, 0};
    if (words_[REQUEST_KIND] != NONE) {
        command.request_number = words_[REQUEST_NUMBER];
        command.request_kind = words_[REQUEST_KIND];
    }
    return command;
}

// Bring the words up to date; nothing is told yet.
void Map::fill() {
    const Command& command = machine_.command();
    words_[IDENTITY] = 0x4850;
    words_[MAP_VERSION] = 1;
    words_[HEARTBEAT] = heartbeat_;
    words_[ECHO] = words_[KEEP_ALIVE] = keep_alive_;
    words_[BOOT_COUNT] = machine_.boot_count();
    words_[STATUS] = machine_.status(false);
    words_[SWITCHES] = machine_.switches();
    words_[FAULT_CODE] = machine_.fault();
    for (uint8_t i = 0; i < 2; i++) {
        put(POSITION + 2 * i, machine_.axis(i).position_mdeg());
        put(VELOCITY + 2 * i, machine_.axis(i).velocity_mdps());
    }
    words_[REQUEST_DONE] = machine_.request_done();
    words_[WATCHDOG] = config::WATCHDOG_MS;
    put(UPTIME, machine_.uptime());
    put_axis(AZIMUTH, command.axes[0]);
    put_axis(ELEVATION, command.axes[1]);
    words_[REQUEST_NUMBER] = command.request_number;
    words_[REQUEST_KIND] = command.request_kind;
    words_[STOP] = 0;
    words_[HORN] = command.horn;
}

Map::Result Map::read(uint16_t address, uint16_t count, uint16_t* words) {
    for (uint16_t i = 0; i < count; i++) {
        if (!is_known(address + i)) return ILLEGAL_ADDRESS;
    }
    heartbeat_++;
    fill();
    machine_.status(true);
    for (uint16_t i = 0; i < count; i++) {
        const uint16_t one = address + i;
        words[i] = is_clock(one) ? machine_.clock.parts[one - CLOCK_FIRST] : words_[one];
    }
    return OK;
}

Map::Result Map::write(uint16_t address, uint16_t count, const uint16_t* words) {
    for (uint16_t i = 0; i < count; i++) {
        if (!is_writable(address + i)) return ILLEGAL_ADDRESS;
    }
    const bool clock_set = address == CLOCK_FIRST && count == WallClock::PARTS;
    if (clock_set && !WallClock::is_date(words)) return ILLEGAL_VALUE;
    fill();
    for (uint16_t i = 0; i < count; i++) {
        if (!is_clock(address + i)) words_[address + i] = words[i];
    }
    if (clock_set) memcpy(machine_.clock.parts, words, sizeof(machine_.clock.parts));
    return act();
}

Map::Result Map::act() {
    const bool motions = words_[AZIMUTH] <= 2 && words_[ELEVATION] <= 2;
    if (!motions || words_[REQUEST_KIND] >= REQUESTS) return ILLEGAL_VALUE;
    const Command wanted = command();
    const bool alive = words_[KEEP_ALIVE] != keep_alive_;
    if (words_[STOP] != 0) machine_.halt();
    else if (alive || !(wanted == machine_.command())) machine_.obey(wanted, alive);
    keep_alive_ = words_[KEEP_ALIVE];
    return OK;
}

Map::Result Map::inputs(uint16_t address, uint16_t count, uint32_t& bits) {
    if (address >= INPUTS || count > INPUTS - address) return ILLEGAL_ADDRESS;
    bits = (static_cast<uint32_t>(machine_.switches()) << 16 | machine_.status(true)) >> address;
    if (count < INPUTS) bits &= (1UL << count) - 1;
    return OK;
}

Map::Result Map::stop(uint16_t address, uint16_t count, bool on) {
    if (address != 0 || count != 1) return ILLEGAL_ADDRESS;
    if (on) machine_.halt();
    return OK;
}
