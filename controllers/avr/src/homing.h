// The search of one axis for the middle of its home switch.
#pragma once
#include <stdint.h>

#include "axis.h"

class Homing {
  public:
    enum class State : uint8_t { IDLE, DOWN, UP, LEAVE_UP, LEAVE_DOWN, MIDDLE, FOUND, FAILED };

    void start(Axis& axis);
    void stop(Axis& axis);
    void step(Axis& axis, uint8_t switches);  // once a millisecond
    bool searching() const { return state_ != State::IDLE && state_ < State::FOUND; }
    bool found() const { return state_ == State::FOUND; }

  private:
    void seek(Axis& axis, State state, float dps);
    void middle(Axis& axis);

    State state_ = State::IDLE;
    bool inside_ = false;  // the home switch has been on in this state
    int32_t begin_ = 0;
    int32_t upper_edge_ = 0;
};
