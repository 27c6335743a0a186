// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// A recording as a folder in the form of TUM. An image is named in its list once its file is whole,
// depth first: a killed program leaves no line that cannot be used.
#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "core/error.h"
#include "io/calibration/calibration.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/growing_file.h"
#include "io/primitives/image_file.h"
#include "io/recordings/recording_formats.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

class TumRecording : public RecordingWriter {
 public:
  TumRecording(const std::string& folder, const ImageOrigin& origin)
      : folder_(folder), camera_(origin.camera()), truth_(origin.ground_truth()) {}

  void add(const RgbdImage& image) override {
    if (!color_list_) begin();
    const std::string stamp = fmt::format("{:.6f}", image.stamp);
    const std::string color = "rgb/" + stamp + ".png";
    const std::string depth = "depth/" + stamp + ".png";
    write_image(color, image.color);
    if (!image.depth.empty()) {
      bool exact = false;
      const cv::Mat raw = raw_depth(image.depth, camera_.depth_factor, exact);
      if (!exact && notes_.empty()) {
        notes_.push_back(
            fmt::format("depth was rounded to 1/{:g} m, and what is beyond {:.1f} m "
                        "left out: the images have 16 bits",
                        camera_.depth_factor, UINT16_MAX / camera_.depth_factor));
      }
      write_image(depth, raw);
      depth_list_->append(stamp + " " + depth + "\n");
    }
    color_list_->append(stamp + " " + color + "\n");
    ++size_;
  }

  void finish() override {}
  std::size_t size() const override { return size_; }
  const std::vector<std::string>& notes() const override { return notes_; }

 private:
  void begin() {
    for (const char* images : {"rgb", "depth"}) make_folder((folder_ / images).string());
    write_file_atomically(file("calibration.yaml"),
                          dump_camera(camera_, "calibration of this recording"));
    if (!truth_.empty()) write_trajectory(file("groundtruth.txt"), truth_);
    depth_list_.emplace(file("depth.txt"));
    color_list_.emplace(file("rgb.txt"));
  }

  void write_image(const std::string& name, const cv::Mat& image) const {
    const std::string path = file(name);
    try {
      GrowingFile(path).append(encode_image(path, image));
    } catch (...) {
      std::error_code error;
      fs::remove(path, error);
      throw;
    }
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
  Camera camera_;
  Trajectory truth_;
  std::optional<GrowingFile> color_list_, depth_list_;
  std::size_t size_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<RecordingWriter> create_tum_recording(const std::string& path,
                                                      const ImageOrigin& origin) {
  return std::make_unique<TumRecording>(path, origin);
}

}  // namespace dxslam
