// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace dxslam {

/// Files of compiled networks, each with a checksum that is verified before it is used: one flipped
/// byte would otherwise give other features without a word. A cache is never needed: what cannot be
/// read, is damaged or cannot be written is as good as not there. Any number of threads and
/// processes at a time.
class ModelCache {
 public:
  /// `folder` is made if it is not there; "" is for no cache.
  explicit ModelCache(const std::string& folder);

  /// One sentence if the folder cannot be used; "" otherwise.
  const std::string& note() const { return note_; }
  bool usable() const { return !folder_.empty() && note_.empty(); }

  /// The content stored under `key`, whole and as it was; a damaged file is removed.
  std::optional<std::string> load(const std::string& key) const;
  /// Whole or not at all; no error where it cannot be written.
  void store(const std::string& key, std::string_view content) const;
  void remove(const std::string& key) const;

 private:
  std::string path_of(const std::string& key) const;

  std::string folder_;
  std::string note_;
};

}  // namespace dxslam
