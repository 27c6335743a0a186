// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "core/error.h"
#include "io/primitives/text_file.h"
#include "io/recordings/nearest_in_time.h"
#include "io/recordings/sequence_formats.h"
#include "io/recordings/stamp_hint.h"

namespace dxslam {
namespace {

struct StampedFile {
  double stamp = 0.0;
  std::string file;
};

/// A line whose stamp an earlier line has, and why it was left out.
struct RepeatedLine {
  double stamp = 0.0;
  std::string reason;
};

/// Lines of one file in time order.
struct StampedList {
  std::vector<StampedFile> files;
  std::vector<RepeatedLine> repeated;
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

// Whether the stamp goes on with the list; a repeated one is noted, an earlier one refused.
bool goes_on(const std::string& path, int line, double stamp, StampedList& list) {
  if (list.files.size() == limits::kFrames) {
    throw InputError(fmt::format("{}: more than {} frames, expected less", at_line(path, line),
                                 limits::kFrames));
  }
  if (list.files.empty() || stamp > list.files.back().stamp) return true;
  const auto same =
      std::lower_bound(list.files.begin(), list.files.end(), stamp,
                       [](const StampedFile& item, double value) { return item.stamp < value; });
  if (same->stamp == stamp) {
    list.repeated.push_back(
        {stamp, fmt::format("{}: stamp {:.16g} was given before", at_line(path, line), stamp)});
    return false;
  }
  throw InputError(fmt::format("{}: stamp {:.16g} after {:.16g}, expected rising stamps",
                               at_line(path, line), stamp, list.files.back().stamp));
}

StampedList read_list(const std::string& folder, const std::string& name) {
  const std::string path = in_folder(folder, name);
  StampedList list;
  for_each_row(path, "a list of 'stamp file' lines", [&](const TextRow& row) {
    refuse_decimal_comma(path, row);
    const std::string_view file = listed_name(folder, path, row);
    const double stamp = finite_field(path, row, 0, "stamp");
    if (!goes_on(path, row.line, stamp, list)) return;
    list.files.push_back({stamp, in_folder(folder, std::string(file))});
  });
  if (list.files.empty()) {
    throw InputError(fmt::format("{}: empty list, expected 'stamp file' lines", path));
  }
  return list;
}

// Repeated lines count as skipped frames, at the frame behind them.
void skip_repeated(const std::vector<RepeatedLine>& repeated, SequenceListing& listing) {
  for (const RepeatedLine& line : repeated) {
    const auto behind = std::lower_bound(
        listing.frames.begin(), listing.frames.end(), line.stamp,
        [](const ListedFrame& frame, double value) { return frame.stamp < value; });
    listing.skipped.push_back(
        {static_cast<std::size_t>(behind - listing.frames.begin()), line.reason});
  }
}

void read_associations(const std::string& folder, const std::string& path,
                       SequenceListing& listing) {
  StampedList colors;
  for_each_row(path, "an association file", [&](const TextRow& row) {
    refuse_decimal_comma(path, row);
    if (row.fields.size() < 4) refuse_columns(path, row, "4 (stamp colour stamp depth)");
    const Association pair = split_association(folder, path, row);
    const double stamp = finite_field(path, row, 0, "stamp");
    if (!goes_on(path, row.line, stamp, colors)) return;
    colors.files.push_back({stamp, in_folder(folder, pair.color)});
    listing.frames.push_back({stamp, colors.files.back().file, in_folder(folder, pair.depth)});
  });
  if (listing.frames.empty()) {
    throw InputError(fmt::format("{}: empty, expected 'stamp colour stamp depth' lines", path));
  }
  skip_repeated(colors.repeated, listing);
}

// What explains that no stamp has a partner.
std::string unit_hint(const std::string& name, const StampedList& list) {
  std::vector<double> stamps;
  for (const StampedFile& file : list.files) stamps.push_back(file.stamp);
  const std::string hint = stamp_hint(stamps);
  return hint.empty() ? hint : fmt::format("; {}: {}", name, hint);
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
        "same recording{}{}",
        folder, color_list, depth_list, options.max_association_s, least,
        unit_hint(color_list, colors), unit_hint(depth_list, depths)));
  }
  skip_repeated(colors.repeated, listing);
  if (!depths.repeated.empty()) {
    listing.notes.push_back(fmt::format("lines of {} that were left out: {}; the first, {}",
                                        depth_list, depths.repeated.size(),
                                        depths.repeated.front().reason));
  }
}

}  // namespace dxslam
