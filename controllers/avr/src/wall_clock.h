// The controller's own clock, UTC.
#pragma once
#include <stdint.h>

struct WallClock {
    enum Part : uint8_t { YEAR, MONTH, DAY, HOUR, MINUTE, SECOND, PARTS };
    uint16_t parts[PARTS] = {2000, 1, 1, 0, 0, 0};

    void tick();  // once a second
    static bool is_date(const uint16_t* parts);
};
