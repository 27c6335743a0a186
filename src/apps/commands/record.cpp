// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <exception>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/open_recording.h"
#include "apps/output_steps.h"
#include "apps/process.h"
#include "apps/progress.h"
#include "apps/recording_report.h"
#include "apps/usage.h"
#include "core/error.h"
#include "core/image_source.h"
#include "io/recordings/recording_writer.h"

namespace dxslam::apps {
namespace {

struct RecordArguments {
  SequenceOptions reader;
  std::string source;
  std::string out;
  ImageSelection selection;
};

// Nothing at the end and after a stop. What cannot be read costs this image alone.
std::optional<RgbdImage> next_image(ImageSource& source, std::vector<SkippedFrame>& failed) {
  const std::stop_callback ends(stop_token(), [&source] { source.stop(); });
  for (;;) {
    try {
      return source.next();
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& e) {
      failed.push_back(skipped_for(source.index(), e));
    }
  }
}

void write_images(ImageSource& source, RecordingWriter& writer, std::vector<SkippedFrame>& failed) {
  Progress progress("images", source.planned().value_or(0));
  while (const std::optional<RgbdImage> image = next_image(source, failed)) {
    writer.add(*image);
    progress.update(source.passed(), "recording");
  }
  progress.finish();
}

int record(const RecordArguments& arguments) {
  const auto source = open_images(arguments.source, arguments.reader, arguments.selection);
  const auto writer = create_recording(arguments.out, *source);
  print_recording(*source);
  OutputSteps steps;
  std::vector<SkippedFrame> failed;
  {
    const Unsaved unsaved;
    steps.run([&] { write_images(*source, *writer, failed); });
    steps.run([&] { writer->finish(); });
  }
  for (const std::string& note : writer->notes()) warn("{}", note);
  print_skipped(all_skipped(*source, failed));
  if (source->dropped() > 0) {
    warn("images that came too fast and were dropped: {}", source->dropped());
  }
  if (writer->size() == 0 && steps.failures().empty() && !stop_requested()) {
    throw InputError(arguments.source + ": no image could be used, so nothing was recorded");
  }
  print("{} images in {}\n", writer->size(), arguments.out);
  return steps.report(stop_requested() ? kInterrupted : kSuccess);
}

}  // namespace

void add_record_command(CLI::App& app) {
  const auto arguments = std::make_shared<RecordArguments>();
  CLI::App* command = app.add_subcommand(
      "record", "write a source down as MCAP, which ROS 2 reads, or as a folder of images");
  command->add_option("SOURCE", arguments->source, source_help())->required();
  command->add_option("--out", arguments->out, "new file that ends in .mcap, or new folder")
      ->required();
  add_reader_options(*command, arguments->reader);
  command->add_option("--association", arguments->reader.association,
                      "file that pairs colour with depth images");
  command->add_option("--stride", arguments->selection.stride, "take every n-th image")
      ->check(whole_number(1));
  command->add_option("--max-frames", arguments->selection.most, "stop after so many, 0 = all")
      ->check(whole_number(0));
  command->callback([arguments] {
    if (const int code = record(*arguments); code != kSuccess) throw CLI::RuntimeError(code);
  });
}

}  // namespace dxslam::apps
