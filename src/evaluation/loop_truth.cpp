// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/loop_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/error.h"
#include "evaluation/mat_file.h"
#include "io/primitives/image_file.h"
#include "io/primitives/input_file.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr std::size_t kMostFrames = 40000;  // 100 MB
constexpr int kWhite = 128;

void check_square(const std::string& path, std::size_t rows, std::size_t columns) {
  if (rows != columns || rows < 2 || rows > kMostFrames) {
    throw InputError(
        fmt::format("{}: a matrix of {} x {} elements, expected a square one of true loops, 2 to "
                    "{} frames",
                    path, rows, columns, kMostFrames));
  }
}

LoopTruth make_square(const std::string& path, std::size_t rows, std::size_t columns) {
  check_square(path, rows, columns);
  return LoopTruth(rows);
}

void mark(LoopTruth& truth, std::size_t row, std::size_t column) {
  if (row != column) truth.set(row, column, PairTruth::kSame);
}

LoopTruth from_mat(const std::string& path) {
  std::optional<LoopTruth> truth;
  read_mat(
      path,
      [&](const MatShape& shape) { truth.emplace(make_square(path, shape.rows, shape.columns)); },
      [&](std::size_t row, std::size_t column, double) { mark(*truth, row, column); });
  return *std::move(truth);
}

LoopTruth from_image(const std::string& path) {
  cv::Mat image = read_color_image(path);
  if (image.channels() == 3) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
  LoopTruth truth =
      make_square(path, static_cast<std::size_t>(image.rows), static_cast<std::size_t>(image.cols));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      if (image.at<std::uint8_t>(y, x) < kWhite) continue;
      mark(truth, static_cast<std::size_t>(y), static_cast<std::size_t>(x));
    }
  }
  return truth;
}

// The first row says how many rows there must be, so that none has to be kept.
LoopTruth from_text(const std::string& path) {
  std::optional<LoopTruth> truth;
  std::size_t rows = 0;
  std::size_t columns = 0;
  for_each_row(path, "a matrix of true loops", [&](const TextRow& row) {
    if (!truth) {
      columns = row.fields.size();
      if (columns < 2 || columns > kMostFrames) {
        refuse_columns(path, row, fmt::format("2 to {}, one per frame", kMostFrames));
      }
      truth.emplace(make_square(path, columns, columns));
    }
    if (row.fields.size() != columns) {
      refuse_columns(path, row, fmt::format("{} as in the first row", columns));
    }
    for (std::size_t j = 0; j < columns; ++j) {
      if (finite_field(path, row, j, "matrix element") == 0.0) continue;
      if (rows < columns) mark(*truth, rows, j);
    }
    ++rows;
  });
  check_square(path, rows, columns);
  return *std::move(truth);
}

// What a file begins with; nothing is waited for where it is a pipe.
std::string start_of(const std::string& path) {
  const InputFile file(path, "a matrix of true loops");
  std::string start(16, '\0');
  start.resize(file.read(start.data(), start.size()));
  return start;
}

bool has_loop(const LoopTruth& truth) {
  for (std::size_t i = 0; i < truth.frames(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (truth.at(i, j) == PairTruth::kSame) return true;
    }
  }
  return false;
}

}  // namespace

LoopTruth::LoopTruth(std::size_t frames)
    : frames_(frames), same_(frames < 2 ? 0 : frames * (frames - 1) / 2, false) {}

std::size_t LoopTruth::cell(std::size_t a, std::size_t b) const {
  require(a < frames_ && b < frames_ && a != b, "a pair of frames beyond the true loops");
  const std::size_t later = std::max(a, b);
  return later * (later - 1) / 2 + std::min(a, b);
}

PairTruth LoopTruth::at(std::size_t a, std::size_t b) const {
  const std::size_t k = cell(a, b);
  if (same_[k]) return PairTruth::kSame;
  return !unclear_.empty() && unclear_[k] ? PairTruth::kUnclear : PairTruth::kDifferent;
}

void LoopTruth::set(std::size_t a, std::size_t b, PairTruth truth) {
  const std::size_t k = cell(a, b);
  same_[k] = truth == PairTruth::kSame;
  if (truth == PairTruth::kUnclear && unclear_.empty()) unclear_.assign(same_.size(), false);
  if (!unclear_.empty()) unclear_[k] = truth == PairTruth::kUnclear;
}

LoopTruth read_loop_truth(const std::string& path) {
  const std::string start = start_of(path);
  LoopTruth truth = begins_as_mat_file(start) ? from_mat(path)
                    : begins_as_image(start)  ? from_image(path)
                                              : from_text(path);
  if (!has_loop(truth)) {
    throw InputError(fmt::format("{}: no true loop in it, expected at least one", path));
  }
  return truth;
}

LoopTruth every_nth(const LoopTruth& truth, std::size_t first, std::size_t step) {
  require(step > 0, "a step of 0 frames");
  const std::size_t frames =
      first < truth.frames() ? (truth.frames() - first + step - 1) / step : 0;
  LoopTruth part(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const PairTruth pair = truth.at(first + i * step, first + j * step);
      if (pair != PairTruth::kDifferent) part.set(i, j, pair);
    }
  }
  return part;
}

}  // namespace dxslam
