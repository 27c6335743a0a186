// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/output_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "io/primitives/atomic_file.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

std::string_view trimmed(std::string_view line) {
  const std::size_t first = line.find_first_not_of(' ');
  return first == std::string_view::npos ? std::string_view() : line.substr(first);
}

bool has_fields(std::string_view text, const std::vector<std::string>& fields) {
  std::size_t found = 0;
  bool inside = false;
  while (!text.empty() && found < fields.size()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!inside && line == "[]") return true;
    if (line == "{" || (!inside && line == "[")) {
      inside = inside || line == "{";
      continue;
    }
    if (!inside || !line.starts_with(fmt::format("\"{}\":", fields[found]))) return false;
    ++found;
  }
  return found == fields.size();
}

std::string ending_of(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

// Of what is there; nothing where there is nothing.
bool is_stream(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

FileKind kind_by_beginning(std::string name, std::vector<std::string> beginnings,
                           std::vector<std::string> endings) {
  const auto matches = [beginnings = std::move(beginnings)](std::string_view head) {
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](const std::string& beginning) { return head.starts_with(beginning); });
  };
  return {std::move(name), matches, std::move(endings)};
}

FileKind json_kind(std::string name, std::vector<std::string> first_fields) {
  return {std::move(name), [fields = std::move(first_fields)](std::string_view head) {
            return has_fields(head, fields);
          }};
}

void require_kind_or_nothing(const std::string& path, const FileKind& kind) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return;
  std::array<char, kFileHead> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(fmt::format("{}: cannot be read, expected {} or a new name", path, kind.name));
  }
  file.read(head.data(), head.size());
  const std::string_view bytes(head.data(), static_cast<std::size_t>(file.gcount()));
  if (bytes.empty() || kind.matches(bytes)) return;
  throw InputError(fmt::format("{}: is not {} and is not replaced, expected {} or a new name", path,
                               kind.name, kind.name));
}

void require_target(const std::string& path, const FileKind& kind) {
  const auto& endings = kind.endings;
  if (!endings.empty() && !is_stream(path) &&
      std::find(endings.begin(), endings.end(), ending_of(path)) == endings.end()) {
    throw InputError(fmt::format("{}: is to be {}, expected a name that ends in {}", path,
                                 kind.name, fmt::join(endings, " or ")));
  }
  require_kind_or_nothing(path, kind);
  require_writable(path);
}

std::string canonical_target(const std::string& path) {
  std::error_code error;
  const fs::path behind = fs::absolute(target_behind_links(path), error);
  const fs::path canonical = fs::weakly_canonical(behind, error);
  return error ? behind.lexically_normal().string() : canonical.string();
}

bool is_same_target(const std::string& a, const std::string& b) {
  if (is_stream(a) || is_stream(b)) return false;
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  return canonical_target(a) == canonical_target(b);
}

}  // namespace dxslam
