#include "hil/recording/mcap_export.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "hil/recording/recorded_packets.h"
#include "hil/text/json_text.h"
#include "hil/text/little_endian.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::uint64_t kChunk_ns = 1'000'000'000;

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kDataEnd = 0x0f,
};

void put_record(std::string& out, Opcode opcode, std::string_view content) {
  put_u8(out, opcode);
  put_u64(out, content.size());
  out += content;
}

// A map or an array of fixed-size entries: its length in bytes in front.
void put_block(std::string& out, std::string_view entries) { put_text(out, entries); }

struct TimedMessage {
  std::uint64_t time_ns = 0;
  std::uint16_t channel = 0;
  std::string data;
};

// Channels with their schemas, numbered from 1 as they come up.
class Channels {
 public:
  std::uint16_t find(const std::string& topic, const std::function<std::string()>& schema) {
    const auto [at, is_new] = ids_.try_emplace(topic, static_cast<std::uint16_t>(ids_.size() + 1));
    if (!is_new) return at->second;
    std::string schema_record, channel_record;
    put_u16(schema_record, at->second);
    put_text(schema_record, topic);
    put_text(schema_record, "jsonschema");
    put_text(schema_record, schema());
    put_record(records_, kSchema, schema_record);
    put_u16(channel_record, at->second);
    put_u16(channel_record, at->second);
    put_text(channel_record, topic);
    put_text(channel_record, "json");
    put_block(channel_record, "");  // no metadata
    put_record(records_, kChannel, channel_record);
    return at->second;
  }
  const std::string& records() const { return records_; }
  std::size_t size() const { return ids_.size(); }

 private:
  std::map<std::string, std::uint16_t> ids_;
  std::string records_;
};

std::string sample_schema(const RecordingHeader& header) {
  nlohmann::ordered_json properties;
  for (std::size_t i = 0; i < header.columns.size(); ++i)
    properties[header.columns[i]] = {{"type", "number"}, {"description", "unit " + header.units[i]}};
  return json_text({{"type", "object"}, {"properties", properties}});
}

std::string packet_schema(const Values& values) {
  nlohmann::ordered_json fields;
  for (const Field& field : values.message->fields)
    fields[std::string(field.name)] = {{"description", "unit " + std::string(field.unit)}};
  return json_text(
      {{"type", "object"},
       {"properties",
        {{"packet", {{"type", "string"}}}, {"fields", {{"type", "object"}, {"properties", fields}}}}}});
}

std::string sample_json(const RecordingHeader& header, const std::vector<double>& sample) {
  std::string out = "{";
  for (std::size_t i = 0; i < sample.size(); ++i) {
    out += (i == 0 ? "\"" : ",\"") + header.columns[i] + "\":";
    append_number(out, sample[i]);
  }
  return out + "}";
}

std::vector<TimedMessage> messages_of(const Recording& recording, const RadioFormat& format,
                                      const PacketToJson& to_json, Channels& channels) {
  const RecordingHeader& header = recording.header;
  const auto unix_ns = [&](std::int64_t now_ns) {
    return header.epoch_ms * 1'000'000 + static_cast<std::uint64_t>(now_ns);
  };
  std::vector<TimedMessage> all;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind != RecordedChunk::Kind::kSample) continue;
    const std::uint16_t channel =
        channels.find("/robot" + std::to_string(chunk.robot_id), [&] { return sample_schema(header); });
    all.push_back({unix_ns(chunk.now_ns), channel, sample_json(header, chunk.sample)});
  }
  for (const PassedPacket& passed : all_packets(recording, format)) {
    if (!passed.packet.frame.understood) continue;
    const DecodeResult decoded = format.decode(passed.packet.frame.bytes);
    const std::string topic =
        std::string(passed.from_host ? "/host/" : "/dongle/") + std::string(decoded.values.message->name);
    const std::uint16_t channel = channels.find(topic, [&] { return packet_schema(decoded.values); });
    all.push_back({unix_ns(passed.packet.now_ns), channel, to_json(decoded.values)});
  }
  std::ranges::stable_sort(all, {}, &TimedMessage::time_ns);
  return all;
}

// What the summary needs of one chunk.
struct ChunkPlace {
  std::uint64_t start_ns, end_ns, offset, length, index_length, size;
  std::map<std::uint16_t, std::uint64_t> index_offsets;
};

ChunkPlace put_chunk(std::string& out, std::span<const TimedMessage> messages,
                     std::vector<std::uint32_t>& sequence) {
  std::string records, content;
  std::map<std::uint16_t, std::string> index;
  for (const TimedMessage& message : messages) {
    put_u64(index[message.channel], message.time_ns);
    put_u64(index[message.channel], records.size());
    std::string record;
    put_u16(record, message.channel);
    put_u32(record, sequence[message.channel]++);
    put_u64(record, message.time_ns);
    put_u64(record, message.time_ns);
    put_record(records, kMessage, record + message.data);
  }
  ChunkPlace place{messages.front().time_ns, messages.back().time_ns, out.size(), 0, 0, records.size(), {}};
  put_u64(content, place.start_ns);
  put_u64(content, place.end_ns);
  put_u64(content, records.size());
  put_u32(content, 0);    // no checksum
  put_text(content, "");  // not compressed
  put_u64(content, records.size());
  put_record(out, kChunk, content + records);
  place.length = out.size() - place.offset;
  const std::size_t indexes = out.size();
  for (const auto& [channel, entries] : index) {
    place.index_offsets[channel] = out.size();
    std::string record;
    put_u16(record, channel);
    put_block(record, entries);
    put_record(out, kMessageIndex, record);
  }
  place.index_length = out.size() - indexes;
  return place;
}

void put_chunk_index(std::string& out, const ChunkPlace& place) {
  std::string record, offsets;
  for (const auto& [channel, offset] : place.index_offsets) {
    put_u16(offsets, channel);
    put_u64(offsets, offset);
  }
  put_u64(record, place.start_ns);
  put_u64(record, place.end_ns);
  put_u64(record, place.offset);
  put_u64(record, place.length);
  put_block(record, offsets);
  put_u64(record, place.index_length);
  put_text(record, "");  // not compressed
  put_u64(record, place.size);
  put_u64(record, place.size);
  put_record(out, kChunkIndex, record);
}

}  // namespace

std::string mcap_of(const Recording& recording, const RadioFormat& format, const PacketToJson& to_json) {
  Channels channels;
  const std::vector<TimedMessage> messages = messages_of(recording, format, to_json, channels);
  std::string out(kMagic), header;
  put_text(header, "");
  put_text(header, "omnihil");
  put_record(out, kHeader, header);
  out += channels.records();
  std::vector<std::uint32_t> sequence(channels.size() + 1);
  std::vector<ChunkPlace> chunks;
  for (std::size_t from = 0; from < messages.size();) {
    std::size_t to = from;
    while (to < messages.size() && messages[to].time_ns < messages[from].time_ns + kChunk_ns) ++to;
    chunks.push_back(put_chunk(out, std::span(messages).subspan(from, to - from), sequence));
    from = to;
  }
  std::string end;
  put_u32(end, 0);
  put_record(out, kDataEnd, end);
  const std::uint64_t summary = out.size();
  out += channels.records();
  for (const ChunkPlace& place : chunks) put_chunk_index(out, place);
  std::string statistics, counts;
  for (std::size_t channel = 1; channel < sequence.size(); ++channel) {
    put_u16(counts, static_cast<std::uint16_t>(channel));
    put_u64(counts, sequence[channel]);
  }
  put_u64(statistics, messages.size());
  put_u16(statistics, static_cast<std::uint16_t>(channels.size()));
  put_u32(statistics, static_cast<std::uint32_t>(channels.size()));
  put_u32(statistics, 0);  // attachments
  put_u32(statistics, 0);  // metadata
  put_u32(statistics, static_cast<std::uint32_t>(chunks.size()));
  put_u64(statistics, messages.empty() ? 0 : messages.front().time_ns);
  put_u64(statistics, messages.empty() ? 0 : messages.back().time_ns);
  put_block(statistics, counts);
  put_record(out, kStatistics, statistics);
  std::string footer;
  put_u64(footer, summary);
  put_u64(footer, 0);  // no summary offsets
  put_u32(footer, 0);  // no checksum
  put_record(out, kFooter, footer);
  out += kMagic;
  return out;
}

}  // namespace omnihil
