// Both axes with switches, brakes, watchdog, homing and faults.
#pragma once
#include <stdint.h>

#include "axis.h"
#include "homing.h"
#include "wall_clock.h"

enum Request : uint16_t { NONE, SET_HOME_AZIMUTH, SET_HOME_ELEVATION, HOME, RESET_FAULT, REQUESTS };
enum Fault : uint16_t { NO_FAULT, EMERGENCY_STOP = 1, BOTH_LIMITS = 2, HARDWARE_WATCHDOG = 3 };

struct Command {
    AxisCommand axes[2];
    bool horn;
    uint16_t request_number;
    uint16_t request_kind;

    bool operator==(const Command& other) const;
    bool is_halt() const;
};

class Machine {
  public:
    void begin(uint16_t boot_count, uint16_t fault);
    void tick(uint16_t from);  // every millisecond, in the timer interrupt
    void obey(const Command& command, bool alive);
    void halt();
    uint16_t status(bool told);
    uint16_t switches() const;
    const Command& command() const { return command_; }
    const Axis& axis(uint8_t number) const { return axes_[number]; }
    uint16_t fault() const { return fault_; }
    uint16_t boot_count() const { return boot_count_; }
    uint16_t request_done() const { return request_done_; }
    uint32_t uptime() const { return uptime_; }
    WallClock clock;

  private:
    void read_inputs();
    void count_time();
    void watch();
    void search();
    void guard();
    void move(uint8_t number, uint16_t from);
    bool brake_free(uint8_t number, bool moving);
    void turn(const Command& command);
    void take_request(const Command& command);
    void answer(bool done);
    void begin_homing();
    void end_homing(bool failed);
    bool barred() const;

    Axis axes_[2];
    Homing homings_[2];
    Command command_ = {};
    uint8_t last_inputs_ = 0;
    uint8_t inputs_ = 0;  // equal in two readings
    uint16_t fault_ = NO_FAULT;
    uint16_t boot_count_ = 0;
    uint16_t request_seen_ = 0;
    uint16_t request_done_ = 0;
    bool request_failed_ = false;
    bool homing_ = false;
    bool fed_ = false;
    bool tripped_ = false;
    bool trip_was_read_ = false;
    uint16_t unfed_ms_ = 0;
    uint16_t ms_ = 0;
    uint32_t uptime_ = 0;
    uint16_t brake_ms_[2] = {0, 0};
    bool released_[2] = {false, false};
};
