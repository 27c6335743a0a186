// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "mutation.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "map_files/map_sections.h"
#include "map_files/section_file.h"

namespace dxslam::fuzz {
namespace {

// What a section is made of: records of one size behind some bytes.
struct Records {
  std::size_t first = 0;
  std::size_t size = 4;
};
Records records_of(const std::string& id, Chance& chance) {
  if (id == kKeyframesId) return {8, 88};
  if (id == kPointsId) return {4, chance.one_in(2) ? std::size_t{72} : std::size_t{8}};
  if (id == kLoopsId) return {4, 64};
  if (id == kThumbnailsId) return {0, 13};
  return {4, chance.one_in(2) ? std::size_t{4} : std::size_t{32}};
}

void spoil_value(std::string& bytes, Chance& chance) {
  const std::size_t width = std::size_t{1} << chance.below(4);
  if (bytes.size() < 8) return;
  std::size_t at = chance.below(
      std::min<std::size_t>(bytes.size() - 7, chance.one_in(3) ? 24 : ~std::size_t{0}));
  if (!chance.one_in(6)) at &= ~std::size_t{3};
  std::uint64_t value = 0;
  std::memcpy(&value, &bytes[at], width);
  switch (chance.below(6)) {
    case 0:
      value ^= std::uint64_t{1} << chance.below(8 * width);
      break;
    case 1:
      value += chance.one_in(2) ? 1 : ~std::uint64_t{0};
      break;
    case 2: {
      double number = 0.0;
      std::memcpy(&number, &bytes[at], sizeof number);
      number = chance.number(number);
      std::memcpy(&bytes[at], &number, sizeof number);
      return;
    }
    case 3: {
      float number = 0.0F;
      std::memcpy(&number, &bytes[at], sizeof number);
      number = chance.number(number);
      std::memcpy(&bytes[at], &number, sizeof number);
      return;
    }
    case 4:
      value = chance.id(static_cast<std::uint32_t>(value), 8);
      break;
    default:
      value = chance.bits() >> chance.below(64);
  }
  std::memcpy(&bytes[at], &value, width);
}

void spoil_records(const std::string& id, std::string& bytes, Chance& chance) {
  const Records r = records_of(id, chance);
  if (bytes.size() < r.first + 2 * r.size) return;
  const std::size_t count = (bytes.size() - r.first) / r.size;
  const std::size_t a = r.first + r.size * chance.below(count);
  const std::size_t b = r.first + r.size * chance.below(count);
  std::string record = bytes.substr(b, r.size);
  const auto add_to_count = [&](std::uint32_t by) {
    std::uint32_t n = 0;
    std::memcpy(&n, bytes.data(), sizeof n);
    n += by;
    if (!chance.one_in(3)) std::memcpy(bytes.data(), &n, sizeof n);
  };
  switch (chance.below(5)) {
    case 0:
      bytes.replace(b, r.size, bytes, a, r.size);
      bytes.replace(a, r.size, record);
      break;
    case 1:
      bytes.insert(a, record);
      add_to_count(1);
      break;
    case 2:
      bytes.erase(a, r.size);
      add_to_count(~std::uint32_t{0});
      break;
    case 3:
      bytes.replace(a, r.size, record);
      break;
    default:
      bytes.resize(chance.below(bytes.size()));
  }
}

// Mostly none: the more is spoiled, the less of it comes past the door.
std::size_t few(Chance& chance) { return chance.one_in(3) ? 1 + chance.below(3) : 0; }

struct Piece {
  Section head;
  std::string bytes;
};

void spoil_pieces(std::vector<Piece>& pieces, Chance& chance) {
  const std::size_t i = chance.below(pieces.size());
  switch (chance.below(4)) {
    case 0:
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    case 1:
      pieces.push_back(pieces[i]);
      break;
    case 2:
      std::swap(pieces[i], pieces[chance.below(pieces.size())]);
      break;
    default:
      pieces[i].head.version = chance.id(1, 2);
      pieces[i].head.required = chance.one_in(2);
  }
}

bool is_finite(const Frame& frame) {
  return cv::checkRange(frame.descriptors) &&
         (frame.global.empty() || cv::checkRange(cv::Mat(frame.global)));
}

std::string without_checks(const MapSnapshot& snapshot, bool exact) {
  // What is not finite has no coding in bytes.
  for (const Keyframe& k : snapshot.parts.keyframes) exact = exact || !is_finite(*k.frame);
  const DescriptorTraits& traits = snapshot.header.traits;
  const DescriptorCoding floats = exact ? DescriptorCoding::kFloat32 : DescriptorCoding::kInt8;
  SectionWriter file(0);
  write_header(snapshot.header, snapshot.parts.rig, file);
  write_cameras(snapshot.parts.rig, file);
  write_keyframes(snapshot.parts, file);
  write_keypoints(snapshot.parts, traits, traits.binary ? DescriptorCoding::kBytes : floats, file);
  // Those of another length than the header says cannot be written.
  const bool fit = std::all_of(
      snapshot.parts.keyframes.begin(), snapshot.parts.keyframes.end(), [&](const Keyframe& k) {
        return k.frame->global.empty() ||
               k.frame->global.size() == static_cast<std::size_t>(traits.global_dimension);
      });
  if (fit) write_globals(snapshot.parts, traits, floats, file);
  write_points(snapshot.parts, file);
  write_loops(snapshot.loops, file);
  write_thumbnails(snapshot.thumbnails, file);
  return file.finish();
}

}  // namespace

void spoil_bytes(const std::string& id, std::string& bytes, Chance& chance) {
  if (chance.one_in(4)) return spoil_records(id, bytes, chance);
  spoil_value(bytes, chance);
}

std::string spoiled_file(MapSnapshot snapshot, Chance& chance) {
  const bool bytes_too = chance.one_in(3);
  for (std::size_t edits = (bytes_too ? 0 : 1) + few(chance); edits > 0; --edits) {
    spoil_content(snapshot, chance);
  }
  const std::string sound = without_checks(snapshot, chance.one_in(2));
  if (!bytes_too) return sound;
  std::vector<Piece> pieces;
  for (const Section& s : read_sections(sound, "a map just made")) {
    pieces.push_back({s, std::string(s.bytes)});
  }
  if (chance.one_in(20)) spoil_pieces(pieces, chance);
  for (std::size_t edits = 1 + few(chance); edits > 0 && !pieces.empty(); --edits) {
    Piece& piece = pieces[chance.below(pieces.size())];
    spoil_bytes(piece.head.id, piece.bytes, chance);
  }
  SectionWriter file(0);
  for (const Piece& piece : pieces) {
    file.begin(piece.head.id.c_str(), piece.head.version, piece.head.required);
    file.put_array(piece.bytes.data(), piece.bytes.size());
  }
  return file.finish();
}

}  // namespace dxslam::fuzz
