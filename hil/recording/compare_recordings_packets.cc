#include <algorithm>
#include <cmath>
#include <map>

#include "hil/recording/compare_recordings_parts.h"
#include "hil/recording/recorded_packets.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

class PacketComparer {
 public:
  PacketComparer(const RadioFormat& format, const Tolerances& tolerances, RecordingComparison& result,
                 DifferenceNotes& notes)
      : format_(format), tolerances_(tolerances), result_(result), notes_(notes) {}

  // False when the streams are out of step from here on.
  bool compare(const RecordedPacket* a, const RecordedPacket* b) {
    if (a == nullptr || b == nullptr) return missing(a, b);
    ++result_.packets;
    result_.bytes += a->frame.bytes.size();
    if (!a->frame.understood || !b->frame.understood) return compare_raw(*a, *b);
    const DecodeResult left = format_.decode(a->frame.bytes);
    const DecodeResult right = format_.decode(b->frame.bytes);
    if (left.values.message != right.values.message) return other_message(*a, left, right);
    compare_time(*a, *b, left);
    compare_fields(*a, left, right);
    return true;
  }

 private:
  bool missing(const RecordedPacket* a, const RecordedPacket* b) {
    const auto text = [&](const RecordedPacket* p) {
      return p == nullptr ? std::string("none") : name_of(*p);
    };
    notes_.differs({(a != nullptr ? a : b)->now_ns, -1, "packet", text(a), text(b), "", 0.0});
    return false;
  }
  bool compare_raw(const RecordedPacket& a, const RecordedPacket& b) {
    if (a.frame.bytes == b.frame.bytes) return true;
    const FrameCutter::Frame& clear = a.frame.understood ? a.frame : b.frame;
    const int robot = clear.understood ? packet_robot(format_.decode(clear.bytes).values) : -1;
    notes_.differs({a.now_ns, robot, "packet", name_of(a), name_of(b), "", 0.0});
    return a.frame.bytes.size() == b.frame.bytes.size();
  }
  bool other_message(const RecordedPacket& a, const DecodeResult& left, const DecodeResult& right) {
    notes_.differs({a.now_ns, packet_robot(left.values), "packet", std::string(left.values.message->name),
                    std::string(right.values.message->name), "", 0.0});
    return false;
  }
  void compare_time(const RecordedPacket& a, const RecordedPacket& b, const DecodeResult& left) {
    const double tolerance_s = tolerances_.packet_time_s();
    const double difference_s = std::abs(static_cast<double>(a.now_ns - b.now_ns)) * 1e-9;
    const int robot = packet_robot(left.values);
    notes_.value(notes_.signal("packet_time_s", "s", tolerance_s), difference_s, a.now_ns, robot);
    if (difference_s <= tolerance_s) return;
    notes_.differs({std::min(a.now_ns, b.now_ns), robot,
                    "time of packet " + std::string(left.values.message->name), seconds(a.now_ns),
                    seconds(b.now_ns), "s", tolerance_s});
  }
  void compare_fields(const RecordedPacket& a, const DecodeResult& left, const DecodeResult& right) {
    const Message& message = *left.values.message;
    const int robot = packet_robot(left.values);
    if (left.values.text != right.values.text) {
      notes_.differs({a.now_ns, robot, "packet " + std::string(message.name) + " text",
                      in_quotes(left.values.text), in_quotes(right.values.text), "", 0.0});
    }
    const std::vector<FieldRule>& rules = rules_of(message);
    for (std::size_t i = 0; i < message.fields.size(); ++i) {
      const Field& field = message.fields[i];
      if (field.kind == FieldKind::kChecksum) continue;  // follows from the others
      const double x = left.values.fields[i].number;
      const double y = right.values.fields[i].number;
      const double difference = std::abs(x - y);
      notes_.value(rules[i].signal, difference, a.now_ns, robot);
      if (difference <= rules[i].tolerance) continue;
      notes_.differs({a.now_ns, robot,
                      "packet " + std::string(message.name) + " field " + std::string(field.name),
                      number_text(x), number_text(y), std::string(field.unit), rules[i].tolerance});
    }
  }

  struct FieldRule {
    std::size_t signal = 0;
    double tolerance = 0.0;
  };
  const std::vector<FieldRule>& rules_of(const Message& message) {
    std::vector<FieldRule>& rules = rules_[std::string(message.name)];
    if (rules.empty()) {
      for (const Field& field : message.fields) {
        if (field.kind == FieldKind::kChecksum) {
          rules.emplace_back();  // follows from the others: not compared
          continue;
        }
        const double tolerance = tolerances_.of_field(message.name, field);
        const std::string name = std::string(message.name) + "." + std::string(field.name);
        rules.push_back({notes_.signal(name, field.unit, tolerance), tolerance});
      }
    }
    return rules;
  }
  std::string name_of(const RecordedPacket& packet) const {
    const DecodeResult decoded = format_.decode(packet.frame.bytes);
    const std::string hex = to_hex(packet.frame.bytes);
    if (!packet.frame.understood) return "refused (" + std::string(to_string(decoded.error)) + ") " + hex;
    return std::string(decoded.values.message->name) + " " + hex;
  }
  static std::string number_text(double value) {
    std::string text;
    append_number(text, value);
    return text;
  }
  static std::string seconds(std::int64_t now_ns) { return number_text(static_cast<double>(now_ns) / 1e9); }

  const RadioFormat& format_;
  const Tolerances& tolerances_;
  RecordingComparison& result_;
  DifferenceNotes& notes_;
  std::map<std::string, std::vector<FieldRule>> rules_;
};

}  // namespace

void compare_packets(const Recording& recorded, const Recording& replayed, const RadioFormat& format,
                     const Tolerances& tolerances, RecordingComparison& result, DifferenceNotes& notes) {
  const std::vector<RecordedPacket> a = dongle_packets(recorded, format);
  const std::vector<RecordedPacket> b = dongle_packets(replayed, format);
  PacketComparer comparer(format, tolerances, result, notes);
  const std::size_t count = recorded.complete ? std::max(a.size(), b.size()) : a.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!comparer.compare(i < a.size() ? &a[i] : nullptr, i < b.size() ? &b[i] : nullptr)) return;
  }
}

}  // namespace omnihil
