// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <glog/logging.h>

namespace dxslam {

/// Ceres warns through glog, which writes to stderr unless the host program has set it up. Where it
/// has, its log is left as it is; else the warnings are held back for as long as this lives.
class QuietLog {
 public:
  QuietLog() : level_(FLAGS_minloglevel) {
    if (!google::IsGoogleLoggingInitialized()) FLAGS_minloglevel = google::GLOG_FATAL;
  }
  ~QuietLog() { FLAGS_minloglevel = level_; }
  QuietLog(const QuietLog&) = delete;
  QuietLog& operator=(const QuietLog&) = delete;

 private:
  int level_;
};

}  // namespace dxslam
