// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/sequence_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "io/calibration/calibration.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

struct StampedFile {
  double stamp = 0.0;
  std::string file;
};

void check_rising(const std::string& path, int line, const std::vector<StampedFile>& list) {
  const std::size_t n = list.size();
  if (n < 2 || list[n - 1].stamp > list[n - 2].stamp) return;
  throw InputError(fmt::format("{}: stamp {:.6f} after {:.6f}, expected rising stamps",
                               at_line(path, line), list[n - 1].stamp, list[n - 2].stamp));
}

std::vector<StampedFile> read_list(const std::string& folder, const std::string& name) {
  const std::string path = in_folder(folder, name);
  std::vector<StampedFile> list;
  for (const TextRow& row : read_table(path, "a list of 'stamp file' lines")) {
    if (row.fields.size() != 2) {
      throw InputError(fmt::format("{}: {} columns, expected 2 (stamp file)",
                                   at_line(path, row.line), row.fields.size()));
    }
    list.push_back({finite_field(path, row, 0, "stamp"), in_folder(folder, row.fields[1])});
    check_rising(path, row.line, list);
  }
  if (list.empty()) {
    throw InputError(fmt::format("{}: empty list, expected 'stamp file' lines", path));
  }
  return list;
}

void read_associations(const std::string& folder, const std::string& path,
                       SequenceListing& listing) {
  std::vector<StampedFile> colors;
  for (const TextRow& row : read_table(path, "an association file")) {
    if (row.fields.size() != 4) {
      throw InputError(fmt::format("{}: {} columns, expected 4 (stamp colour stamp depth)",
                                   at_line(path, row.line), row.fields.size()));
    }
    finite_field(path, row, 2, "depth stamp");
    colors.push_back({finite_field(path, row, 0, "stamp"), in_folder(folder, row.fields[1])});
    check_rising(path, row.line, colors);
    listing.frames.push_back(
        {colors.back().stamp, colors.back().file, in_folder(folder, row.fields[3])});
  }
  if (listing.frames.empty()) {
    throw InputError(fmt::format("{}: empty, expected 'stamp colour stamp depth' lines", path));
  }
}

const StampedFile& nearest(const std::vector<StampedFile>& list, double stamp) {
  const auto after =
      std::lower_bound(list.begin(), list.end(), stamp,
                       [](const StampedFile& item, double value) { return item.stamp < value; });
  if (after == list.begin()) return *after;
  const auto before = std::prev(after);
  if (after == list.end() || stamp - before->stamp <= after->stamp - stamp) return *before;
  return *after;
}

}  // namespace

std::string in_folder(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

std::string folder_name(const std::string& folder) {
  const std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

bool use_explicit_calibration(const std::string& folder, const SequenceOptions& options,
                              SequenceListing& listing) {
  std::string source = options.calibration;
  for (const char* name : {"calibration.yaml", "camera.yaml"}) {
    const std::string own = in_folder(folder, name);
    if (source.empty() && std::filesystem::exists(own)) source = own;
  }
  if (source.empty()) return false;
  const RgbdCalibration calibration = load_calibration(source);
  listing.camera = calibration.camera;
  if (!calibration.depth_camera.registered()) {
    listing.register_depth = DepthRegistration(listing.camera, calibration.depth_camera);
  }
  listing.calibration_source = source;
  return true;
}

void associate_lists(const std::string& folder, const std::string& color_list,
                     const std::string& depth_list, const SequenceOptions& options,
                     SequenceListing& listing) {
  if (!options.association.empty()) {
    return read_associations(folder, options.association, listing);
  }
  const std::vector<StampedFile> colors = read_list(folder, color_list);
  const std::vector<StampedFile> depths = read_list(folder, depth_list);
  double least = std::abs(nearest(depths, colors.front().stamp).stamp - colors.front().stamp);
  for (const StampedFile& color : colors) {
    const StampedFile& depth = nearest(depths, color.stamp);
    const double difference = std::abs(depth.stamp - color.stamp);
    least = std::min(least, difference);
    if (difference <= options.max_association_s) {
      listing.frames.push_back({color.stamp, color.file, depth.file});
    } else {
      listing.skipped.push_back(
          {listing.frames.size(),
           fmt::format("{}: nearest depth image is {:.3f} s away, expected at most {} s",
                       color.file, difference, options.max_association_s)});
    }
  }
  if (listing.frames.empty()) {
    throw InputError(fmt::format(
        "{}: no image of {} has one of {} within {} s (nearest {:.3f} s), expected lists of the "
        "same recording",
        folder, color_list, depth_list, options.max_association_s, least));
  }
}

SE3 pose_from_row_major(const double (&values)[16], const std::string& where) {
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = values[i];
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const double skewness =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skewness <= 0.01) || rotation.determinant() < 0.0) {
    throw InputError(fmt::format("{}: rotation part is off orthonormal by {:.3g}, expected a pose",
                                 where, skewness));
  }
  if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-6) {
    throw InputError(fmt::format("{}: last row of the pose is not 0 0 0 1", where));
  }
  return {Eigen::Quaterniond(rotation), Eigen::Vector3d(matrix.topRightCorner<3, 1>())};
}

}  // namespace dxslam
