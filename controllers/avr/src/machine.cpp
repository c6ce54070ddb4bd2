#include "machine.h"

#include "board.h"
#include "config.h"

bool Command::operator==(const Command& other) const {
    for (uint8_t i = 0; i < 2; i++) {
        const AxisCommand &one = axes[i], &two = other.axes[i];
        if (one.motion != two.motion || one.setpoint != two.setpoint || one.speed != two.speed) return false;
    }
    return horn == other.horn && request_number == other.request_number && request_kind == other.request_kind;
}

bool Command::is_halt() const { return axes[0].motion == Motion::HALT && axes[1].motion == Motion::HALT; }

void Machine::begin(uint16_t boot_count, uint16_t fault) {
    boot_count_ = boot_count;
    fault_ = fault;
    axes_[0].begin(0);
    axes_[1].begin(1);
}

void Machine::tick(uint16_t from) {
    read_inputs();
    count_time();
    watch();
    guard();
    search();
    move(0, from);
    move(1, from);
    board::HORN.set(command_.horn);
}

void Machine::read_inputs() {
    const uint8_t read = board::inputs();
    inputs_ = (read & last_inputs_) | (inputs_ & (read ^ last_inputs_));
    last_inputs_ = read;
}

void Machine::count_time() {
    if (++ms_ < 1000) return;
    ms_ = 0;
    uptime_++;
    clock.tick();
}

void Machine::watch() {
    if (!fed_ || tripped_ || ++unfed_ms_ <= config::WATCHDOG_MS) return;
    tripped_ = true;
    end_homing(true);
    turn({});
}

// Stop for the emergency stop, for switches that contradict each other, and for the local switch.
void Machine::guard() {
    const uint8_t azimuth = inputs_ & board::SWITCHES, elevation = azimuth >> 3;
    const uint8_t both = board::LOWER | board::UPPER;
    if (inputs_ & board::EMERGENCY) {
        fault_ = EMERGENCY_STOP;
        for (Axis& axis : axes_) {
            axis.cut();
            axis.forget_home();
        }
    } else if (fault_ == NO_FAULT && ((azimuth & both) == both || (elevation & both) == both)) {
        fault_ = BOTH_LIMITS;
    }
    if (!barred()) return;
    end_homing(true);
    axes_[0].halt();
    axes_[1].halt();
}

bool Machine::barred() const { return fault_ != NO_FAULT || inputs_ & board::LOCAL; }

void Machine::search() {
    if (!homing_) return;
    bool searching = false, found = true;
    for (uint8_t i = 0; i < 2; i++) {
        homings_[i].step(axes_[i], inputs_ >> (3 * i));
        searching |= homings_[i].searching();
        found &= homings_[i].found();
    }
    if (!searching) end_homing(!found);
}

void Machine::move(uint8_t number, uint16_t from) {
    Axis& axis = axes_[number];
    axis.aim(inputs_ >> (3 * number));
    if (brake_free(number, axis.moving())) axis.plan(from);
}

// Hold the brake's output; return whether the axis may move.
bool Machine::brake_free(uint8_t number, bool moving) {
    uint16_t& waited = brake_ms_[number];
    if (moving != released_[number]) {
        const uint16_t wait = moving ? 0 : config::BRAKE_ENGAGE_MS;
        if (waited++ >= wait) {
            released_[number] = moving;
            board::BRAKE[number].set(moving);
            waited = 0;
        }
    } else if (!moving) {
        waited = 0;
    } else if (waited <= config::BRAKE_RELEASE_MS) {
        waited++;
    }
    return moving && released_[number] && waited + 1 > config::BRAKE_RELEASE_MS;
}

void Machine::obey(const Command& command, bool alive) {
    if (alive) {
        fed_ = true;
        unfed_ms_ = 0;
        if (trip_was_read_) tripped_ = trip_was_read_ = false;
    }
    if (command == command_ || tripped_) return;
    take_request(command);
    if (homing_ && command.is_halt()) {
        command_ = command;
        return;
    }
    end_homing(true);
    turn(command);
}

void Machine::halt() {
    unfed_ms_ = 0;
    end_homing(true);
    turn({});
}

void Machine::turn(const Command& command) {
    command_ = command;
    for (uint8_t i = 0; i < 2; i++) {
        if (barred()) axes_[i].halt();
        else axes_[i].obey(command.axes[i]);
    }
}

void Machine::take_request(const Command& command) {
    if (command.request_kind == NONE || command.request_number == request_seen_) return;
    request_seen_ = command.request_number;
    if (command.request_kind == SET_HOME_AZIMUTH) {
        answer(axes_[0].set_home());
    } else if (command.request_kind == SET_HOME_ELEVATION) {
        answer(axes_[1].set_home());
    } else if (command.request_kind == RESET_FAULT) {
        fault_ = NO_FAULT;  // a cause that persists sets it again within a millisecond
        answer(true);
    } else {
        begin_homing();
    }
}

void Machine::answer(bool done) {
    request_done_ = request_seen_;
    request_failed_ = !done;
}

void Machine::begin_homing() {
    if (barred()) {
        answer(false);
        return;
    }
    homing_ = true;
    for (uint8_t i = 0; i < 2; i++) homings_[i].start(axes_[i]);
}

void Machine::end_homing(bool failed) {
    if (!homing_) return;
    homing_ = false;
    if (failed) {
        for (uint8_t i = 0; i < 2; i++) homings_[i].stop(axes_[i]);
    }
    answer(!failed);
}

uint16_t Machine::status(bool told) {
    if (told) trip_was_read_ = tripped_;
    return axes_[0].moving() | axes_[1].moving() << 1 | axes_[0].homed() << 2 | axes_[1].homed() << 3
        | homing_ << 4 | tripped_ << 5 | request_failed_ << 6 | ((inputs_ & board::LOCAL) != 0) << 7;
}

uint16_t Machine::switches() const { return inputs_ & board::SWITCHES; }
