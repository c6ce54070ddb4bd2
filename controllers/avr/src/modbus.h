// Modbus RTU frames: functions 1 to 6, 15 and 16.
#pragma once
#include <stdint.h>

#include "map.h"

// Answer a frame in place; return the reply's length, 0 for silence.
uint16_t answer(Map& map, uint8_t* frame, uint16_t length);
