// The Heliopanel axis map: registers, discrete inputs and the coil of profile simulated-plc.
#pragma once
#include <stdint.h>

#include "machine.h"

class Map {
  public:
    enum Result : uint8_t { OK = 0, ILLEGAL_FUNCTION = 1, ILLEGAL_ADDRESS = 2, ILLEGAL_VALUE = 3 };

    explicit Map(Machine& machine) : machine_(machine) {}
    Result read(uint16_t address, uint16_t count, uint16_t* words);
    Result write(uint16_t address, uint16_t count, const uint16_t* words);
    Result inputs(uint16_t address, uint16_t count, uint32_t& bits);
    Result stop(uint16_t address, uint16_t count, bool on);

  private:
    void fill();
    void put(uint8_t address, uint32_t value);
    uint32_t pair(uint8_t address) const;
    void put_axis(uint8_t address, const AxisCommand& command);
    AxisCommand axis_command(uint8_t address) const;
    Command command() const;
    Result act();

    Machine& machine_;
    uint16_t keep_alive_ = 0;
    uint16_t heartbeat_ = 0;
    uint16_t words_[40] = {};
};
