#include "axis.h"

#include <math.h>
#include <stdlib.h>

#include "board.h"
#include "config.h"
#include "steps.h"

namespace {

constexpr int32_t ONE = 1048576;  // 2^20, one step
constexpr float STEPS_PER_DEG = config::STEPS_PER_TURN / 360.0F;
constexpr float SPEED_UNIT = STEPS_PER_DEG / 1000.0F * ONE;  // of 1 deg/s
constexpr float MDPS_PER_UNIT = 1000.0F / SPEED_UNIT;
static_assert(config::AXES[0].speed_dps * STEPS_PER_DEG <= 10000, "at most 10,000 steps a second");
static_assert(config::AXES[1].speed_dps * STEPS_PER_DEG <= 10000, "at most 10,000 steps a second");

constexpr int32_t common(int32_t one, int32_t two) { return two == 0 ? one : common(two, one % two); }
constexpr int32_t COMMON = common(config::MDEG_PER_TURN, config::STEPS_PER_TURN);
constexpr int32_t MDEG = config::MDEG_PER_TURN / COMMON, STEPS = config::STEPS_PER_TURN / COMMON;
static_assert(3LL * config::STEPS_PER_TURN * MDEG < 2147483647LL / 2, "three turns in 32 bits");

int32_t clamped(int32_t value, int32_t low, int32_t high) {
    return value < low ? low : value > high ? high : value;
}

int32_t steps_of(int32_t mdeg) {
    return lround(static_cast<float>(mdeg % config::MDEG_PER_TURN) * (STEPS_PER_DEG / 1000.0F))
        + mdeg / config::MDEG_PER_TURN * config::STEPS_PER_TURN;
}

}  // namespace

void Axis::begin(uint8_t number) {
    number_ = number;
    acceleration_ = lround(config::AXES[number].acceleration_dps2 / 1000.0F * SPEED_UNIT);
    whole_ = steps_of(config::AXES[number].start_mdeg);
    steps::set_position(number, whole_);
}

int32_t Axis::speed_of(float dps) const {
    const float most = config::AXES[number_].speed_dps;
    return lround((dps > most ? most : dps < -most ? -most : dps) * SPEED_UNIT);
}

void Axis::obey(const AxisCommand& command) {
    const int32_t most = 1080L * 1000;
    if (command.motion == Motion::VELOCITY) {
        turn(speed_of(command.setpoint / 1000.0F));
    } else if (command.motion == Motion::POSITION && command.speed > 0) {
        go_to(steps_of(clamped(command.setpoint, -most, most)), speed_of(command.speed / 1000.0F));
    } else {
        halt();
    }
}

void Axis::turn(int32_t speed) {
    motion_ = Motion::VELOCITY;
    target_ = speed;
}

void Axis::go_to(int32_t steps, int32_t speed) {
    motion_ = Motion::POSITION;
    target_ = steps;
    limit_ = speed;
    far_ = (0.5F * speed / acceleration_ + 2.0F) * speed;
}

void Axis::halt() {
    motion_ = Motion::HALT;
}

void Axis::cut() {
    steps::drop(number_);
    motion_ = Motion::HALT;
    goal_ = velocity_ = 0;
    whole_ = steps::position(number_);
    fraction_ = 0;
}

bool Axis::moving() const {
    return goal_ != 0 || velocity_ != 0 || steps::position(number_) != whole_;
}

bool Axis::set_home() {
    if (moving()) return false;
    whole_ = fraction_ = 0;
    motion_ = Motion::HALT;
    steps::set_position(number_, 0);
    return homed_ = true;
}

int32_t Axis::position_mdeg() const {
    const int32_t turned = steps::position(number_) * MDEG;
    return (turned + (turned < 0 ? -STEPS / 2 : STEPS / 2)) / STEPS;
}

int32_t Axis::velocity_mdps() const { return lround(velocity_ * MDPS_PER_UNIT); }

// Return the speed from which the axis can still brake to its target, with its sign.
int32_t Axis::approach() {
    const float way = static_cast<float>(target_ - whole_) * ONE - static_cast<float>(fraction_);
    const float left = fabsf(way);
    if (left <= acceleration_ && labs(velocity_) <= 2 * acceleration_) {
        arrives_ = true;
        return lround(way);
    }
    if (left > far_) return way < 0 ? -limit_ : limit_;
    const float grip = acceleration_;
    const float allowed = grip * (sqrtf(0.25F + 2.0F * left / grip) - 0.5F);
    const int32_t speed = allowed < limit_ ? lround(allowed) : limit_;
    return way < 0 ? -speed : speed;
}

int32_t Axis::wanted() {
    arrives_ = false;
    if (motion_ == Motion::VELOCITY) return target_;
    return motion_ == Motion::POSITION ? approach() : 0;
}

int32_t Axis::within_switches(int32_t speed, uint8_t switches) const {
    if (switches & board::LOWER && speed < 0) return 0;
    return switches & board::UPPER && speed > 0 ? 0 : speed;
}

void Axis::aim(uint8_t switches) {
    goal_ = within_switches(wanted(), switches);
    barred_ = velocity_ != within_switches(velocity_, switches);
}

void Axis::plan(uint16_t from) {
    if (steps::is_full(number_)) return;
    if (arrives_) {
        velocity_ = 0;
        advance(goal_, from);
        return;
    }
    const int32_t most = barred_ ? acceleration_ * config::SWITCH_BRAKING : acceleration_;
    velocity_ = clamped(goal_, velocity_ - most, velocity_ + most);
    advance(velocity_, from);
}

// Move the planned position by less than ten steps and order the steps that it passes.
void Axis::advance(int32_t way, uint16_t from) {
    if (way == 0) return;
    const bool forward = way > 0;
    const uint32_t size = forward ? way : -way;
    const uint32_t to_first = forward ? ONE - fraction_ : fraction_ + 1;
    fraction_ += way;
    const int32_t passed = fraction_ >> 20;
    fraction_ &= ONE - 1;
    whole_ += passed;
    const uint8_t count = forward ? passed : -passed;
    if (count == 0) return;
    const uint16_t first = to_first * steps::TICKS_PER_MS / size;
    const uint32_t interval = static_cast<uint32_t>(ONE) * steps::TICKS_PER_MS / size;
    steps::add(number_, {static_cast<uint16_t>(from + first), static_cast<uint16_t>(interval), count, forward});
}
