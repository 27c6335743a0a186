// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/openloris_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr const char* kExpected =
    "an OpenLORIS-Scene result (scene: NAME, frame: NAME, then seq: N and poses)";
constexpr std::size_t kPoseColumns = 8;
constexpr double kQuaternionTolerance = 0.01;
constexpr double kLargestNumber = 1e6;  // of a sequence

struct Row {
  StampedPose pose;
  std::optional<double> output_time;
};

struct Header {
  std::string key;
  std::string value;
};

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

// "key: value" in any spacing; nothing for a row of numbers.
std::optional<Header> as_header(const TextRow& row) {
  const std::string line = fmt::format("{}", fmt::join(row.fields, " "));
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos) return std::nullopt;
  return Header{trimmed(line.substr(0, colon)), trimmed(line.substr(colon + 1))};
}

// Nothing for a row that holds NaN or an infinity where the pose should be: no pose.
std::optional<Row> as_pose(const std::string& path, const TextRow& row) {
  const std::size_t columns = row.fields.size();
  if (columns != kPoseColumns && columns != kPoseColumns + 1) {
    throw InputError(fmt::format(
        "{}: {} columns, expected 8 or 9 (stamp [output_time] x y z qx qy qz qw) or \"key: value\"",
        at_line(path, row.line), columns));
  }
  Row result;
  result.pose.stamp = finite_field(path, row, 0, "stamp");
  if (columns > kPoseColumns) result.output_time = finite_field(path, row, 1, "output time");
  double v[7];
  for (std::size_t i = 0; i < 7; ++i) {
    const std::size_t field = columns - 7 + i;
    const auto number = parse_number(row.fields[field]);
    if (number && !std::isfinite(*number)) return std::nullopt;
    v[i] = finite_field(path, row, field, "pose");
  }
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  if (!(std::abs(rotation.norm() - 1.0) <= kQuaternionTolerance)) {
    throw InputError(fmt::format("{}: quaternion of length {:.4g}, expected 1",
                                 at_line(path, row.line), rotation.norm()));
  }
  result.pose.world_from_camera = SE3(rotation, Eigen::Vector3d(v[0], v[1], v[2]));
  return result;
}

void take_rows(std::vector<Row>& rows, OpenlorisSequence& sequence) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.pose.stamp < b.pose.stamp; });
  bool all_timed = true;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i + 1 < rows.size() && rows[i + 1].pose.stamp == rows[i].pose.stamp) continue;
    sequence.poses.push_back(rows[i].pose);
    sequence.output_times.push_back(rows[i].output_time.value_or(0.0));
    all_timed = all_timed && rows[i].output_time;
  }
  if (!all_timed) sequence.output_times.clear();
  rows.clear();
}

// Collects what the lines of a file say, one after the other.
class ResultParser {
 public:
  explicit ResultParser(std::string path) : path_(std::move(path)) {}

  void take(const TextRow& row) {
    if (const auto header = as_header(row)) {
      take_header(*header, row.line);
    } else if (result_.sequences.empty()) {
      throw InputError(fmt::format("{}: a pose before the first \"seq: N\", expected {}",
                                   at_line(path_, row.line), kExpected));
    } else if (auto pose = as_pose(path_, row)) {
      rows_.push_back(*pose);
    }
  }

  OpenlorisResult finish() {
    if (result_.scene.empty()) refuse("scene: NAME");
    if (result_.frame.empty()) refuse("frame: NAME");
    if (result_.sequences.empty()) refuse("seq: N");
    take_rows(rows_, result_.sequences.back());
    std::sort(result_.sequences.begin(), result_.sequences.end(),
              [](const auto& a, const auto& b) { return a.number < b.number; });
    return std::move(result_);
  }

 private:
  [[noreturn]] void refuse(const char* missing) const {
    throw InputError(fmt::format("{}: no line \"{}\", expected {}", path_, missing, kExpected));
  }

  // Headers may be repeated before each sequence, but have to say the same.
  void set(std::string& value, const Header& header, int line) {
    if (!value.empty() && value != header.value) {
      throw InputError(fmt::format("{}: {} is {} after {}, expected one {} a file",
                                   at_line(path_, line), header.key, in_quotes(header.value),
                                   in_quotes(value), header.key));
    }
    value = header.value;
  }

  void take_header(const Header& header, int line) {
    if (header.key == "scene") {
      set(result_.scene, header, line);
    } else if (header.key == "frame") {
      set(result_.frame, header, line);
    } else if (header.key == "seq") {
      begin_sequence(header.value, line);
    } else if (header.key == "aided_reloc" && !result_.sequences.empty()) {
      result_.sequences.back().aided = header.value == "true" || header.value == "True";
    }
  }

  void begin_sequence(const std::string& text, int line) {
    const auto number = parse_number(text);
    if (!number || !(*number >= 0.0 && *number <= kLargestNumber) ||
        *number != std::floor(*number)) {
      throw InputError(fmt::format("{}: sequence {}, expected a whole number", at_line(path_, line),
                                   in_quotes(text)));
    }
    if (!result_.sequences.empty()) take_rows(rows_, result_.sequences.back());
    OpenlorisSequence sequence;
    sequence.number = static_cast<int>(*number);
    for (const OpenlorisSequence& earlier : result_.sequences) {
      if (earlier.number != sequence.number) continue;
      throw InputError(fmt::format("{}: sequence {} a second time, expected each once",
                                   at_line(path_, line), sequence.number));
    }
    result_.sequences.push_back(std::move(sequence));
  }

  std::string path_;
  OpenlorisResult result_;
  std::vector<Row> rows_;  // of the last sequence
};

void check(const OpenlorisResult& result) {
  require(!result.scene.empty() && !result.frame.empty(), "a result needs scene and frame");
  for (std::size_t i = 0; i < result.sequences.size(); ++i) {
    const OpenlorisSequence& sequence = result.sequences[i];
    require(sequence.number >= 0 && (i == 0 || result.sequences[i - 1].number < sequence.number),
            "sequences must have rising numbers");
    require(sequence.output_times.empty() || sequence.output_times.size() == sequence.poses.size(),
            "output times must be none or one per pose");
    require(std::is_sorted(sequence.poses.begin(), sequence.poses.end(),
                           [](const auto& a, const auto& b) { return a.stamp < b.stamp; }),
            "poses must be by rising stamp");
  }
}

}  // namespace

OpenlorisResult read_openloris_result(const std::string& path) {
  ResultParser parser(path);
  for_each_row(path, kExpected, [&](const TextRow& row) { parser.take(row); });
  return parser.finish();
}

FileKind openloris_kind() {
  return kind_by_beginning("poses in OpenLORIS-Scene format", {"scene: "});
}

void write_openloris_result(const std::string& path, const OpenlorisResult& result) {
  check(result);
  std::string text = fmt::format("scene: {}\nframe: {}\n", result.scene, result.frame);
  for (const OpenlorisSequence& sequence : result.sequences) {
    text += fmt::format("\nseq: {}\naided_reloc: {}\n", sequence.number, sequence.aided);
    for (std::size_t i = 0; i < sequence.poses.size(); ++i) {
      const StampedPose& pose = sequence.poses[i];
      const Eigen::Vector3d& t = pose.world_from_camera.translation();
      const Eigen::Quaterniond& q = pose.world_from_camera.rotation();
      text += fmt::format("{:.6f} ", pose.stamp);
      if (!sequence.output_times.empty()) text += fmt::format("{:.6f} ", sequence.output_times[i]);
      text += fmt::format("{:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", t.x(), t.y(), t.z(),
                          q.x(), q.y(), q.z(), q.w());
    }
  }
  write_file_atomically(path, text);
}

}  // namespace dxslam
