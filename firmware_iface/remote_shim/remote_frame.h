/* Frames between the bench and a board on the desk: COBS( type, sequence, payload, CRC-16 ) 00.
 *
 *   uint8_t wire[OMNIHIL_REMOTE_WIRE_MAX];
 *   size_t n = omnihil_remote_encode(type, sequence, payload, bytes, wire);      // send these n bytes
 *
 *   omnihil_remote_decoder decoder = {0};
 *   omnihil_remote_frame frame;
 *   if (omnihil_remote_decode(&decoder, byte, &frame)) …                         // frame.type, .payload
 *
 * Plain C99, no heap, used by both ends. CRC-16: polynomial 1021h, init FFFFh, most significant bit first, no
 * final XOR ("CRC-16/IBM-3740", check value 29B1h of "123456789"), sent low byte first. It sees every burst
 * of up to 16 bits; of other faults one in 65536 passes. COBS: Cheshire and Baker, IEEE/ACM Trans. Networking
 * 7(2), 1999. Byte tables of the payloads: docs/remote-mcu.md.
 */
#ifndef OMNIHIL_REMOTE_FRAME_H
#define OMNIHIL_REMOTE_FRAME_H
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define OMNIHIL_REMOTE_VERSION 1u
#define OMNIHIL_REMOTE_PAYLOAD_MAX 240u
#define OMNIHIL_REMOTE_BODY_MAX \
  (OMNIHIL_REMOTE_PAYLOAD_MAX + 5u)                            /* type, sequence, CRC; below one COBS block */
#define OMNIHIL_REMOTE_WIRE_MAX (OMNIHIL_REMOTE_BODY_MAX + 2u) /* code byte, delimiter */

/* frame types; from the board they have bit 7 */
enum {
  OMNIHIL_REMOTE_HELLO = 0x01,
  OMNIHIL_REMOTE_SENSORS = 0x02,
  OMNIHIL_REMOTE_COMMAND = 0x03,
  OMNIHIL_REMOTE_RADIO = 0x04,
  OMNIHIL_REMOTE_HELLO_ANSWER = 0x81,
  OMNIHIL_REMOTE_DRIVE = 0x82,
  OMNIHIL_REMOTE_RADIO_OUT = 0x84
};

typedef struct omnihil_remote_frame {
  uint8_t type;
  uint16_t sequence;
  const uint8_t* payload; /* valid until the next byte is decoded */
  size_t bytes;
} omnihil_remote_frame;

typedef struct omnihil_remote_decoder {
  uint8_t body[OMNIHIL_REMOTE_WIRE_MAX];
  size_t count;
  uint8_t overflow;
  uint32_t good, bad_cobs, bad_crc, too_long, too_short; /* frames since the start */
} omnihil_remote_decoder;

uint16_t omnihil_remote_crc16(const uint8_t* bytes, size_t count);
/* Returns the bytes on the wire, 0 if the payload is too long. */
size_t omnihil_remote_encode(uint8_t type, uint16_t sequence, const uint8_t* payload, size_t bytes,
                             uint8_t* wire);
/* Takes one byte; 1 when it ended a good frame. Bad ones are counted by cause and dropped. */
int omnihil_remote_decode(omnihil_remote_decoder* decoder, uint8_t byte, omnihil_remote_frame* frame);

/* Little-endian numbers at an offset. */
void omnihil_put_u16(uint8_t* at, uint16_t value);
void omnihil_put_u32(uint8_t* at, uint32_t value);
void omnihil_put_f32(uint8_t* at, float value);
uint16_t omnihil_get_u16(const uint8_t* at);
uint32_t omnihil_get_u32(const uint8_t* at);
float omnihil_get_f32(const uint8_t* at);

#ifdef __cplusplus
}
#endif
#endif
