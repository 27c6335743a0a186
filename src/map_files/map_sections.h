// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "map_files/descriptor_coding.h"
#include "map_files/map_file.h"
#include "map_files/section_file.h"

namespace dxslam {

// One pair of functions for each section of a map file, in the order of the file. Those that write
// throw ContractError for what must not be saved, those that read throw InputError for what was
// damaged. docs/file_formats.md describes the bytes.

inline constexpr std::uint32_t kSectionVersion = 1;  ///< of all sections so far

inline constexpr const char* kHeaderId = "HEAD";
/// The first camera is in here, as far as this section can say what it is.
void write_header(const MapHeader& header, const Rig& rig, SectionWriter& file);
MapHeader read_header(SectionReader reader, Rig& rig, const std::string& where);

inline constexpr const char* kCamerasId = "CAMR";
/// All cameras, where the header does not say all of them.
void write_cameras(const Rig& rig, SectionWriter& file);
Rig read_cameras(SectionReader reader, const std::string& where);

inline constexpr const char* kKeyframesId = "KEYF";
void write_keyframes(const MapParts& parts, SectionWriter& file);
/// Poses, parents and components; the frames have index, stamp and room for their keypoints, which
/// is bounded by `max_keypoints` for all together.
void read_keyframes(SectionReader reader, std::size_t max_keypoints, MapParts& parts,
                    std::vector<std::shared_ptr<Frame>>& frames);
/// Bytes of one keypoint in the next section.
std::size_t keypoint_size(DescriptorCoding coding, int dimension);

inline constexpr const char* kKeypointsId = "KEYP";
void write_keypoints(const MapParts& parts, const DescriptorTraits& traits, DescriptorCoding coding,
                     SectionWriter& file);
/// How many keypoints the section can hold at most, from its size alone.
std::size_t keypoint_capacity(SectionReader reader, const DescriptorTraits& traits);
void read_keypoints(SectionReader reader, const DescriptorTraits& traits, const Rig& rig,
                    const std::vector<std::shared_ptr<Frame>>& frames);

inline constexpr const char* kGlobalsId = "GLOB";
void write_globals(const MapParts& parts, const DescriptorTraits& traits, DescriptorCoding coding,
                   SectionWriter& file);
void read_globals(SectionReader reader, const DescriptorTraits& traits,
                  const std::vector<std::shared_ptr<Frame>>& frames);

inline constexpr const char* kPointsId = "PNTS";
void write_points(const MapParts& parts, SectionWriter& file);
void read_points(SectionReader reader, MapParts& parts);

inline constexpr const char* kLoopsId = "LOOP";
void write_loops(const std::vector<StoredLoopEdge>& loops, SectionWriter& file);
std::vector<StoredLoopEdge> read_loops(SectionReader reader, const MapParts& parts);

inline constexpr const char* kThumbnailsId = "THUM";
void write_thumbnails(const std::vector<std::string>& thumbnails, SectionWriter& file);
std::vector<std::string> read_thumbnails(SectionReader reader, std::size_t keyframes);

}  // namespace dxslam
