// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>

namespace dxslam {

/// Asks the system to back fresh memory by huge pages, where it can: the first touch of a page of
/// 4 KiB costs more than filling it, and a map has tens of thousands of them. For memory of which
/// the caller owns all and has touched nothing yet.
inline void advise_huge_pages(void* data, std::size_t size) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t kHugePage = std::uintptr_t{2} << 20;
  const auto begin = reinterpret_cast<std::uintptr_t>(data);
  const std::uintptr_t first = (begin + kHugePage - 1) / kHugePage * kHugePage;
  const std::uintptr_t last = (begin + size) / kHugePage * kHugePage;
  if (first < last) ::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#else
  (void)data;
  (void)size;
#endif
}

}  // namespace dxslam
