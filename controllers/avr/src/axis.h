// One axis: a trapezoid of speed, planned in milliseconds; called in the timer interrupt, or while it is held.
#pragma once
#include <stdint.h>

enum class Motion : uint8_t { HALT = 0, VELOCITY = 1, POSITION = 2 };

struct AxisCommand {
    Motion motion;
    int32_t setpoint;  // mdeg or mdeg/s
    uint32_t speed;    // mdeg/s
};

class Axis {
  public:
    void begin(uint8_t number);
    void obey(const AxisCommand& command);
    void turn(int32_t speed);                    // 2^-20 steps/ms, signed
    void go_to(int32_t steps, int32_t speed);
    void halt();
    void cut();                                  // no further step at once
    void aim(uint8_t switches);                  // first in each millisecond: what speed is wanted
    void plan(uint16_t from);                    // then the steps of one; `from` in ticks of timer 1
    bool set_home();                             // only at rest
    void forget_home() { homed_ = false; }
    uint8_t number() const { return number_; }
    bool homed() const { return homed_; }
    bool moving() const;
    int32_t planned() const { return whole_; }
    int32_t position_mdeg() const;
    int32_t velocity_mdps() const;
    int32_t speed_of(float dps) const;

  private:
    int32_t wanted();
    int32_t approach();
    int32_t within_switches(int32_t speed, uint8_t switches) const;
    void advance(int32_t way, uint16_t from);

    uint8_t number_ = 0;
    Motion motion_ = Motion::HALT;
    bool homed_ = false;
    bool arrives_ = false;    // this millisecond ends at the target
    bool barred_ = false;     // moves onto a limit switch
    int32_t goal_ = 0;        // speed or last way, 2^-20 steps/ms
    int32_t target_ = 0;      // steps, or 2^-20 steps/ms
    int32_t limit_ = 0;       // 2^-20 steps/ms
    float far_ = 0;           // 2^-20 steps from which no braking is due yet
    int32_t velocity_ = 0;    // 2^-20 steps/ms
    int32_t whole_ = 0;       // planned position in steps
    int32_t fraction_ = 0;    // 2^-20 steps
    int32_t acceleration_ = 0;
};
