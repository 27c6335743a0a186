// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "features/post_processing/detector_options.h"

namespace dxslam {

// The description of a network that makes a feature extractor of it; manifests/README.md documents
// the file format field by field.

enum class TensorLayout { kNchw, kNhwc };

/// A model file and what it must hash to; `weights_sha256` is of the .bin beside an OpenVINO .xml.
/// Hashes may be empty (a user's own file): then they are not checked.
struct ModelFile {
  std::string path;  ///< with variables and the manifest's folder resolved
  std::string sha256;
  std::string weights_sha256;
  bool given() const { return !path.empty(); }
};

/// The same network in float (f32 or f16 weights) and, where there is one, quantised to INT8.
struct ModelVariants {
  ModelFile floating;
  ModelFile int8;
};

struct InputDescription {
  std::string name;
  int channels = 1;  ///< 1 (grey) or 3
  TensorLayout layout = TensorLayout::kNchw;
  bool bgr = false;                  ///< order of three channels, else RGB
  double scale = 1.0;                ///< 8-bit values are multiplied by this,
  std::vector<double> mean;          ///< then the mean is subtracted, one per channel or empty,
  std::vector<double> deviation;     ///< and divided by the deviation, one per channel or empty
  bool instance_normalized = false;  ///< each image to zero mean and unit deviation (instead)
  /// Added to that deviation, in grey levels, so that noise on an even image stays small.
  double deviation_floor = 0.0;
  /// Blocks of this side become the channels of one place (grey, normalised images only): the
  /// network's input is unshuffle * unshuffle x H / unshuffle x W / unshuffle. 1 = as it is.
  int unshuffle = 1;
  /// What one unit of the input stands for where a model takes 8-bit integers (unshuffled only).
  double quantization_step = 0.0;
  /// Images are padded at the bottom and on the right to a multiple of this.
  int size_multiple = 32;
  /// Where the network has one size: images are scaled to it. 0 = any size.
  int fixed_width = 0;
  int fixed_height = 0;

  /// Channels of the network's input.
  int blocks() const { return channels * unshuffle * unshuffle; }
};

struct OutputDescription {
  std::string name;  ///< of the tensor in the model
  TensorLayout layout = TensorLayout::kNchw;
};

struct DescriptorDescription {
  int dimension = 0;
  int stride = 8;  ///< pixels of the input between neighbours of the descriptor map
  /// Corners of the map lie on the corners of the image: scale (W/stride - 1)/(W - 1), as in the
  /// published HF-Net; else pixel centres, (x + 0.5)/stride - 0.5.
  bool align_corners = false;
  double max_distance = 0.9;  ///< L2, between unit vectors of the same point

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("dimension", self.dimension, {1, 4096}, "floats", "length of a descriptor");
    visit("stride", self.stride, {1, 64}, "pixels", "spacing of the descriptor map");
    visit("align_corners", self.align_corners, "", "corners of map and image coincide");
    visit("max_distance", self.max_distance, {0.01, 2}, "", "L2 distance that a match may have");
  }
};

/// A second graph fed by the `features` output of the first.
struct GlobalHeadDescription {
  ModelVariants files;
  std::string input;
  std::string output;
};

struct ModelManifest {
  std::string path;  ///< the manifest itself
  std::string name;
  std::string description;
  std::string licence;
  ModelVariants files;
  InputDescription input;

  // Where keypoints come from: exactly one of these three.
  std::optional<OutputDescription> keypoint_logits;  ///< cell_size^2 + 1 channels, dustbin last
  std::optional<OutputDescription> scores;           ///< full resolution, one channel
  bool detection_from_descriptors = false;           ///< maxima of the descriptor map (D2-Net)

  OutputDescription descriptors;
  std::optional<OutputDescription> reliability;  ///< one channel at the descriptors' stride;
                                                 ///< multiplies the scores (XFeat)
  std::optional<OutputDescription> features;     ///< what the separate global head reads
  std::optional<OutputDescription> global;       ///< global descriptor made by the same graph
  int global_dimension = 0;                      ///< of either kind; 0 where there is none
  std::optional<GlobalHeadDescription> global_head;

  int cell_size = 8;
  DetectorOptions detector;
  DescriptorDescription descriptor;

  bool has_int8() const { return files.int8.given(); }
};

/// Reads a manifest; unknown keys, missing keys and values out of range are refused. Model files
/// are looked for relative to the manifest, after ${DXSLAM_SHARED} is filled in; they need not
/// exist yet. Throws InputError with file and line.
ModelManifest read_model_manifest(const std::string& path);

/// Throws InputError unless the file (and the .bin of an .xml) exists and has the given hash.
void verify_model_file(const ModelFile& file);

}  // namespace dxslam
