#include "homing.h"

#include "board.h"
#include "config.h"
#include "steps.h"

namespace {
float search_dps(const Axis& axis) { return config::AXES[axis.number()].speed_dps * config::HOMING_SHARE; }
}  // namespace

void Homing::seek(Axis& axis, State state, float dps) {
    state_ = state;
    inside_ = false;
    begin_ = axis.planned();
    axis.turn(axis.speed_of(dps));
}

void Homing::start(Axis& axis) { seek(axis, State::DOWN, -search_dps(axis)); }

void Homing::stop(Axis& axis) {
    state_ = State::FAILED;
    axis.halt();
}

void Homing::step(Axis& axis, uint8_t switches) {
    const bool home = switches & board::HOME;
    const int32_t travel = axis.planned() - begin_;
    if (searching() && (travel < 0 ? -travel : travel) > config::HOMING_TURNS * config::STEPS_PER_TURN) {
        stop(axis);
        return;
    }
    switch (state_) {
        case State::DOWN:
        case State::UP:
            if (home) seek(axis, State::LEAVE_UP, config::HOMING_SLOW_DPS);
            else if (state_ == State::DOWN && switches & board::LOWER) seek(axis, State::UP, search_dps(axis));
            else if (state_ == State::UP && switches & board::UPPER) stop(axis);
            break;
        case State::LEAVE_UP:
            if (home) inside_ = true;
            else if (inside_ && axis.velocity_mdps() > 0) {
                upper_edge_ = steps::position(axis.number());
                seek(axis, State::LEAVE_DOWN, -config::HOMING_SLOW_DPS);
            } else if (switches & board::UPPER) stop(axis);
            break;
        case State::LEAVE_DOWN:
            if (home) inside_ = true;
            else if (inside_) middle(axis);
            else if (switches & board::LOWER) stop(axis);
            break;
        case State::MIDDLE:
            if (!axis.moving()) state_ = axis.set_home() ? State::FOUND : State::FAILED;
            break;
        default:
            break;
    }
}

void Homing::middle(Axis& axis) {
    state_ = State::MIDDLE;
    const int32_t lower_edge = steps::position(axis.number());
    axis.go_to((upper_edge_ + lower_edge) / 2, axis.speed_of(config::HOMING_SLOW_DPS));
}
