// Numbers that fit the firmware to a tracker. Change them here and build again.
#pragma once
#include <stdint.h>

namespace config {

constexpr uint32_t BAUD = 38400;
constexpr uint8_t UNIT = 1;

// Motor steps per turn, times microsteps, times gear 11.25 (belts 16 to 60 and 20 to 60 teeth).
constexpr int32_t STEPS_PER_TURN = 72000;
constexpr int32_t MDEG_PER_TURN = 360000;

struct Limits {
    float speed_dps;
    float acceleration_dps2;
    int32_t start_mdeg;  // what an axis reads that has not been homed
};
constexpr Limits AXES[2] = {{6.0F, 6.0F, 102400}, {4.0F, 6.0F, 36600}};

constexpr int32_t SWITCH_BRAKING = 10;  // an axis on its limit switch brakes this many times harder
constexpr float HOMING_SHARE = 0.5F;    // of the speed, on the way to the home switch
constexpr float HOMING_SLOW_DPS = 0.5F; // across the edges of the home switch
constexpr int32_t HOMING_TURNS = 2;     // travel without a home switch or limit switch that ends the search

constexpr uint16_t WATCHDOG_MS = 500;
constexpr uint16_t BRAKE_RELEASE_MS = 0;  // from the brake's release to the first step
constexpr uint16_t BRAKE_ENGAGE_MS = 500; // from the last step to the brake

constexpr uint16_t PULSE_TICKS = 20;     // 10 us in ticks of timer 1
constexpr uint16_t DIRECTION_TICKS = 40; // 20 us from a change of direction to a step

}  // namespace config
