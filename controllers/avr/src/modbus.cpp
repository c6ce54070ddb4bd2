#include "modbus.h"

#include <avr/io.h>
#include <util/crc16.h>

#include "config.h"

namespace {

constexpr uint16_t MOST_READ = 125, MOST_WRITTEN = 123, COIL_ON = 0xFF00;
uint16_t words[MOST_READ];

uint16_t crc(const uint8_t* bytes, uint16_t count) {
    uint16_t sum = 0xFFFF;
    while (count-- > 0) sum = _crc16_update(sum, *bytes++);
    return sum;
}

uint16_t word(const uint8_t* bytes) { return static_cast<uint16_t>(bytes[0]) << 8 | bytes[1]; }

Map::Result read_words(Map& map, uint8_t* body, uint16_t& length) {
    const uint16_t count = word(body + 2);
    if (length != 4 || count < 1 || count > MOST_READ) return Map::ILLEGAL_VALUE;
    const Map::Result result = map.read(word(body), count, words);
    body[0] = 2 * count;
    for (uint16_t i = 0; i < count; i++) {
        body[1 + 2 * i] = words[i] >> 8;
        body[2 + 2 * i] = words[i];
    }
    length = 1 + 2 * count;
    return result;
}

Map::Result read_bits(Map& map, uint8_t function, uint8_t* body, uint16_t& length) {
    const uint16_t count = word(body + 2);
    if (length != 4 || count < 1 || count > 2000) return Map::ILLEGAL_VALUE;
    uint32_t bits = 0;
    const Map::Result result =
        function == 1 ? map.stop(word(body), count, false) : map.inputs(word(body), count, bits);
    if (result != Map::OK) return result;
    body[0] = (count + 7) / 8;
    for (uint8_t i = 0; i < body[0]; i++) body[1 + i] = bits >> (8 * i);
    length = 1 + body[0];
    return Map::OK;
}

Map::Result write_bit(Map& map, const uint8_t* body, uint16_t length) {
    const uint16_t value = word(body + 2);
    if (length != 4 || (value != 0 && value != COIL_ON)) return Map::ILLEGAL_VALUE;
    return map.stop(word(body), 1, value == COIL_ON);
}

Map::Result write_bits(Map& map, const uint8_t* body, uint16_t& length) {
    const uint16_t count = word(body + 2);
    if (length < 6 || count < 1 || body[4] != (count + 7U) / 8 || length != 5U + body[4]) return Map::ILLEGAL_VALUE;
    length = 4;
    return map.stop(word(body), count, body[5] & 1);
}

Map::Result write_word(Map& map, const uint8_t* body, uint16_t length) {
    if (length != 4) return Map::ILLEGAL_VALUE;
    const uint16_t value = word(body + 2);
    return map.write(word(body), 1, &value);
}

Map::Result write_words(Map& map, const uint8_t* body, uint16_t& length) {
    const uint16_t count = word(body + 2);
    if (length < 5 || count < 1 || count > MOST_WRITTEN || body[4] != 2U * count || length != 5U + body[4]) {
        return Map::ILLEGAL_VALUE;
    }
    for (uint16_t i = 0; i < count; i++) words[i] = word(body + 5 + 2 * i);
    length = 4;
    return map.write(word(body), count, words);
}

// Holds the timer interrupt that moves the machine; step pulses go on.
struct Held {
    Held() { TIMSK2 = 0; }
    ~Held() { TIMSK2 = _BV(OCIE2A); }
};

Map::Result carry_out(Map& map, uint8_t function, uint8_t* body, uint16_t& length) {
    const Held held;
    switch (function) {
        case 1:
        case 2: return read_bits(map, function, body, length);
        case 3:
        case 4: return read_words(map, body, length);
        case 5: return write_bit(map, body, length);
        case 6: return write_word(map, body, length);
        case 15: return write_bits(map, body, length);
        case 16: return write_words(map, body, length);
        default: return Map::ILLEGAL_FUNCTION;
    }
}

}  // namespace

uint16_t answer(Map& map, uint8_t* frame, uint16_t length) {
    if (length < 4 || frame[0] != config::UNIT || crc(frame, length) != 0) return 0;
    uint16_t body = length - 4;
    const Map::Result result = carry_out(map, frame[1], frame + 2, body);
    if (result != Map::OK) {
        frame[1] |= 0x80;
        frame[2] = result;
        body = 1;
    }
    const uint16_t sum = crc(frame, body + 2);
    frame[body + 2] = sum;
    frame[body + 3] = sum >> 8;
    return body + 4;
}
