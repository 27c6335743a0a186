// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "core/error.h"
#include "io/primitives/text_file.h"
#include "io/recordings/nearest_in_time.h"
#include "io/recordings/rising_stamps.h"
#include "io/recordings/sequence_formats.h"
#include "io/recordings/stamp_hint.h"

namespace dxslam {
namespace {

constexpr std::size_t kMostLeftOut = 10;  // one line in so many may be unusable

/// A line of a list; `depth` is empty but in association files.
struct StampedFile {
  double stamp = 0.0;
  std::string file;
  std::string depth;
  int line = 0;
};

/// A line that was left out, and why; one without a stamp has that of the line before.
struct LeftOut {
  double stamp = 0.0;
  std::string reason;
};

/// Lines of one file in time order.
struct StampedList {
  std::vector<StampedFile> files;
  std::vector<LeftOut> left_out;
};

bool exists_in(const std::string& folder, std::string_view name) {
  std::error_code error;
  return std::filesystem::exists(in_folder(folder, std::string(name)), error);
}

// "1305031102,175304 rgb/1.png" would else be read as stamp 1305031102 of the file "175304
// rgb/...".
void refuse_decimal_comma(const std::string& path, const TextRow& row) {
  const std::string_view first =
      std::string_view(row.text).substr(0, row.text.find_first_of(" \t"));
  if (first.size() == row.text.size() || !has_decimal_commas(std::string(first) + " -")) return;
  throw InputError(fmt::format("{}: stamp {} has a decimal comma, expected a decimal point",
                               at_line(path, row.line), in_quotes(first)));
}

// The name in quotes at the beginning of the text, and what comes behind it; nothing without them.
struct Quoted {
  std::string_view name;
  std::string_view rest;
};

std::optional<Quoted> quoted_name(std::string_view text) {
  if (text.size() < 2 || text.front() != '"') return std::nullopt;
  const std::size_t end = text.find('"', 1);
  if (end == std::string_view::npos) return std::nullopt;
  std::string_view rest = text.substr(end + 1);
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t,"), rest.size()));
  return Quoted{text.substr(1, end - 1), rest};
}

// The file of a line "stamp file": all behind the stamp, in quotes or not.
std::string_view listed_name(const std::string& folder, const std::string& path,
                             const TextRow& row) {
  if (row.fields.size() < 2) refuse_columns(path, row, "2 (stamp file)");
  const std::string_view rest = row.rest(1);
  const std::optional<Quoted> quoted = quoted_name(rest);
  if (quoted && quoted->rest.empty()) return quoted->name;
  const bool more_columns =
      row.fields.size() > 2 && !exists_in(folder, rest) && exists_in(folder, row.fields[1]);
  if (more_columns) refuse_columns(path, row, "2 (stamp file)");
  return rest;
}

/// Names and depth stamp of a line "stamp colour stamp depth".
struct Association {
  std::string color;
  std::string depth;
};

std::optional<Association> split_quoted(const std::string& path, const TextRow& row) {
  const std::optional<Quoted> color = quoted_name(row.rest(1));
  if (!color) return std::nullopt;
  const std::vector<TextRow> behind = parse_table(color->rest, path);
  if (behind.empty() || !parse_number(behind.front().fields.front())) return std::nullopt;
  const std::string_view depth = behind.front().rest(1);
  const std::optional<Quoted> quoted = quoted_name(depth);
  if (quoted && quoted->rest.empty())
    return Association{std::string(color->name), std::string(quoted->name)};
  if (depth.empty()) return std::nullopt;
  return Association{std::string(color->name), std::string(depth)};
}

// Where names have blanks in them, the second stamp is the number that parts two existing files.
Association split_association(const std::string& folder, const std::string& path,
                              const TextRow& row) {
  constexpr const char* kColumns = "4 (stamp colour stamp depth)";
  if (const auto quoted = split_quoted(path, row)) return *quoted;
  if (row.fields.size() == 4) {
    finite_field(path, row, 2, "depth stamp");
    return {row.fields[1], row.fields[3]};
  }
  for (std::size_t i = 2; i + 1 < row.fields.size(); ++i) {
    if (!parse_number(row.fields[i])) continue;
    std::string_view color = row.rest(1);
    color = color.substr(0, color.size() - row.rest(i).size());
    color = color.substr(0, color.find_last_not_of(" \t,") + 1);
    const std::string_view depth = row.rest(i + 1);
    if (exists_in(folder, color) && exists_in(folder, depth)) {
      return {std::string(color), std::string(depth)};
    }
  }
  refuse_columns(path, row,
                 fmt::format("{}, names with blanks that exist or stand in quotes", kColumns));
}

// The lines of a file, as `parse` takes them. One line that cannot be used costs no other, but many
// are no accident.
class ListReader {
 public:
  using Parse = std::function<StampedFile(const TextRow&)>;

  ListReader(std::string path, std::string expected)
      : path_(std::move(path)), expected_(std::move(expected)) {}

  StampedList read(const Parse& parse) {
    for_each_row(path_, expected_, [&](const TextRow& row) { take(row, parse); });
    if (rows_ == 0) throw InputError(fmt::format("{}: empty list, expected {}", path_, expected_));
    leave_out_repeated();
    leave_out_what_goes_back();
    if (is_many()) refuse();
    return std::move(list_);
  }

 private:
  void take(const TextRow& row, const Parse& parse) {
    constexpr std::size_t kHopeless = 1000;
    ++rows_;
    if (list_.files.size() == limits::kFrames) {
      throw InputError(fmt::format("{}: more than {} frames, expected less",
                                   at_line(path_, row.line), limits::kFrames));
    }
    try {
      list_.files.push_back(parse(row));
      list_.files.back().line = row.line;
    } catch (const InputError& e) {
      blame(row.line, e.what());
      leave_out(list_.files.empty() ? 0.0 : list_.files.back().stamp, e.what());
      if (unusable_ > kHopeless && is_many()) refuse();
    }
  }

  void leave_out(double stamp, std::string reason) {
    ++unusable_;
    list_.left_out.push_back({stamp, std::move(reason)});
  }

  void blame(int line, std::string problem) {
    if (first_line_ != 0 && first_line_ <= line) return;
    first_line_ = line;
    first_problem_ = std::move(problem);
  }

  // The same file with the same stamp loses nothing, and is no reason to refuse.
  void leave_out_repeated() {
    std::vector<std::size_t> by_stamp(list_.files.size());
    std::iota(by_stamp.begin(), by_stamp.end(), std::size_t{0});
    std::stable_sort(by_stamp.begin(), by_stamp.end(), [&](std::size_t a, std::size_t b) {
      return list_.files[a].stamp < list_.files[b].stamp;
    });
    std::vector<bool> repeated(list_.files.size(), false);
    std::size_t first = 0;  // of the stamp
    for (std::size_t i = 1; i < by_stamp.size(); ++i) {
      const StampedFile& a = list_.files[by_stamp[first]];
      const StampedFile& b = list_.files[by_stamp[i]];
      if (a.stamp != b.stamp) first = i;
      repeated[by_stamp[i]] = a.stamp == b.stamp && a.file == b.file;
    }
    keep_others(repeated, [&](const StampedFile& file) {
      list_.left_out.push_back({file.stamp, fmt::format("{}: stamp {:.16g} was given before",
                                                        at_line(path_, file.line), file.stamp)});
    });
  }

  void leave_out_what_goes_back() {
    std::vector<double> stamps;
    for (const StampedFile& file : list_.files) stamps.push_back(file.stamp);
    // To be blamed is what a reader of the file stumbles over, whichever is left out.
    for (std::size_t i = 1, latest = 0; i < stamps.size(); ++i) {
      if (stamps[i] > stamps[latest]) {
        latest = i;
        continue;
      }
      const int line = list_.files[i].line;
      blame(line, fmt::format("{}: stamp {:.16g} after {:.16g}, expected rising stamps",
                              at_line(path_, line), stamps[i], stamps[latest]));
      if (first_line_ <= line) break;
    }
    keep_others(out_of_order(stamps), [&](const StampedFile& file) {
      leave_out(file.stamp, fmt::format("{}: stamp {:.16g} is not in order",
                                        at_line(path_, file.line), file.stamp));
    });
  }

  template <class Drop>
  void keep_others(const std::vector<bool>& dropped, const Drop& drop) {
    std::vector<StampedFile> kept;
    for (std::size_t i = 0; i < dropped.size(); ++i) {
      if (dropped[i]) {
        drop(list_.files[i]);
      } else {
        kept.push_back(std::move(list_.files[i]));
      }
    }
    list_.files = std::move(kept);
  }

  bool is_many() const { return unusable_ * kMostLeftOut > rows_; }

  [[noreturn]] void refuse() const {
    if (unusable_ == 1) throw InputError(first_problem_);
    throw InputError(
        fmt::format("{}; of {} lines, {} cannot be used", first_problem_, rows_, unusable_));
  }

  std::string path_;
  std::string expected_;
  StampedList list_;
  std::size_t rows_ = 0;
  std::size_t unusable_ = 0;
  int first_line_ = 0;  // of the unusable ones; 0: none
  std::string first_problem_;
};

StampedList read_list(const std::string& folder, const std::string& name) {
  const std::string path = in_folder(folder, name);
  return ListReader(path, "a list of 'stamp file' lines").read([&](const TextRow& row) {
    refuse_decimal_comma(path, row);
    const std::string_view file = listed_name(folder, path, row);
    return StampedFile{
        finite_field(path, row, 0, "stamp"), in_folder(folder, std::string(file)), {}, row.line};
  });
}

// Lines left out count as skipped frames, at the frame behind them.
void skip_left_out(const std::vector<LeftOut>& left_out, SequenceListing& listing) {
  for (const LeftOut& line : left_out) {
    const auto behind = std::lower_bound(
        listing.frames.begin(), listing.frames.end(), line.stamp,
        [](const ListedFrame& frame, double value) { return frame.stamp < value; });
    listing.skipped.push_back(
        {static_cast<std::size_t>(behind - listing.frames.begin()), line.reason});
  }
}

void read_associations(const std::string& folder, const std::string& path,
                       SequenceListing& listing) {
  StampedList pairs =
      ListReader(path, "'stamp colour stamp depth' lines").read([&](const TextRow& row) {
        refuse_decimal_comma(path, row);
        if (row.fields.size() < 4) refuse_columns(path, row, "4 (stamp colour stamp depth)");
        const Association pair = split_association(folder, path, row);
        return StampedFile{finite_field(path, row, 0, "stamp"), in_folder(folder, pair.color),
                           in_folder(folder, pair.depth), row.line};
      });
  for (StampedFile& pair : pairs.files) {
    listing.frames.push_back({pair.stamp, std::move(pair.file), std::move(pair.depth)});
  }
  skip_left_out(pairs.left_out, listing);
}

// What explains that no stamp has a partner.
std::string unit_hint(const std::string& name, const StampedList& list) {
  std::vector<double> stamps;
  for (const StampedFile& file : list.files) stamps.push_back(file.stamp);
  const std::string hint = stamp_hint(stamps);
  return hint.empty() ? hint : fmt::format("; {}: {}", name, hint);
}

std::string hint_for(const std::string& color_list, const StampedList& colors,
                     const std::string& depth_list, const StampedList& depths, double least) {
  constexpr double kMayBelong = 1.0;  // seconds
  const std::string units = unit_hint(color_list, colors) + unit_hint(depth_list, depths);
  if (!units.empty() || least > kMayBelong) return units;
  return "; if images so far apart belong together, --association FILE says which with which";
}

}  // namespace

void associate_lists(const std::string& folder, const std::string& color_list,
                     const std::string& depth_list, const SequenceOptions& options,
                     SequenceListing& listing) {
  if (!options.association.empty()) {
    return read_associations(folder, options.association, listing);
  }
  const StampedList colors = read_list(folder, color_list);
  const StampedList depths = read_list(folder, depth_list);
  double least = std::abs(nearest_in_time(depths.files, colors.files.front().stamp)->stamp -
                          colors.files.front().stamp);
  for (const StampedFile& color : colors.files) {
    const StampedFile& depth = *nearest_in_time(depths.files, color.stamp);
    const double difference = std::abs(depth.stamp - color.stamp);
    least = std::min(least, difference);
    if (difference <= options.max_association_s) {
      listing.frames.push_back({color.stamp, color.file, depth.file});
    } else {
      listing.skipped.push_back(
          {listing.frames.size(),
           fmt::format("{}: nearest depth image is {:.4g} s away, expected at most {} s",
                       color.file, difference, options.max_association_s)});
    }
  }
  if (listing.frames.empty()) {
    throw InputError(fmt::format(
        "{}: no image of {} has one of {} within {} s (nearest {:.4g} s), expected lists of the "
        "same recording{}",
        folder, color_list, depth_list, options.max_association_s, least,
        hint_for(color_list, colors, depth_list, depths, least)));
  }
  skip_left_out(colors.left_out, listing);
  if (!depths.left_out.empty()) {
    listing.notes.push_back(fmt::format("lines of {} that were left out: {}; the first, {}",
                                        depth_list, depths.left_out.size(),
                                        depths.left_out.front().reason));
  }
}

}  // namespace dxslam
