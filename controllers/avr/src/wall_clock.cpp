#include "wall_clock.h"

namespace {

uint8_t days(uint16_t year, uint16_t month) {
    if (month == 2) return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) ? 29 : 28;
    return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
}

}  // namespace

bool WallClock::is_date(const uint16_t* parts) {
    return parts[YEAR] >= 1 && parts[YEAR] <= 9999 && parts[MONTH] >= 1 && parts[MONTH] <= 12
        && parts[DAY] >= 1 && parts[DAY] <= days(parts[YEAR], parts[MONTH])
        && parts[HOUR] < 24 && parts[MINUTE] < 60 && parts[SECOND] < 60;
}

void WallClock::tick() {
    if (++parts[SECOND] < 60) return;
    parts[SECOND] = 0;
    if (++parts[MINUTE] < 60) return;
    parts[MINUTE] = 0;
    if (++parts[HOUR] < 24) return;
    parts[HOUR] = 0;
    if (++parts[DAY] <= days(parts[YEAR], parts[MONTH])) return;
    parts[DAY] = 1;
    if (++parts[MONTH] <= 12) return;
    parts[MONTH] = 1;
    parts[YEAR]++;
}
