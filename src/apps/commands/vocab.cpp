// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "apps/command_files.h"
#include "apps/commands.h"
#include "apps/console.h"
#include "apps/features_arguments.h"
#include "apps/image_stream.h"
#include "apps/process.h"
#include "apps/progress.h"
#include "apps/usage.h"
#include "core/error.h"
#include "core/options.h"
#include "features/extractor_factory.h"
#include "io/primitives/atomic_file.h"
#include "vocabulary/dbow2_text.h"
#include "vocabulary/vocabulary.h"
#include "vocabulary/vocabulary_trainer.h"
#include "vocabulary/vocabulary_tree.h"

namespace dxslam::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kImagesPerCheckpoint = 200;

struct TrainArguments {
  std::vector<std::string> sources;
  std::string out;
  std::string checkpoint;
  FeatureArguments extractor;
  VocabularyTrainingOptions options;
  std::size_t stride = 1;
  unsigned photo_views = 2;
};

// Everything that a checkpoint must agree with.
std::string describe_training(const TrainArguments& arguments, const std::string& features) {
  const VocabularyTrainingOptions& o = arguments.options;
  return fmt::format("{} of {} keypoints {} from {} stride {} views {}: {} {} {} {}", o.method,
                     features, arguments.extractor.options.max_keypoints,
                     fmt::join(arguments.sources, " "), arguments.stride, arguments.photo_views,
                     o.matched_per_image, o.match_ratio, o.max_open_words, o.sample_mb);
}

void add_photo(VocabularyTrainer& trainer, FeatureExtractor& extractor, const cv::Mat& photo,
               std::size_t index, unsigned views) {
  for (unsigned v = 0; v < views; ++v) {
    const cv::Mat view = changed_view(photo, static_cast<unsigned>(index) * views + v);
    trainer.add(extractor.extract(view, false));
  }
}

// The file for the state of a training, if it is to have one.
class Checkpoint {
 public:
  Checkpoint(const VocabularyTrainer& trainer, std::string path, std::string source)
      : trainer_(trainer), path_(std::move(path)), source_(std::move(source)) {
    if (wanted()) require_writable(path_);
  }

  bool wanted() const { return !path_.empty(); }

  /// Throws InputError if it cannot be written.
  void save(std::size_t position) const {
    if (wanted()) trainer_.save(path_, source_, position);
  }

  /// A failure is said once; the training can do without, and the next save tries again.
  void try_to_save(std::size_t position) {
    try {
      save(position);
    } catch (const InputError& error) {
      if (!std::exchange(warned_, true)) warn("{}; the training goes on", error.what());
    }
  }

 private:
  const VocabularyTrainer& trainer_;
  const std::string path_;
  const std::string source_;
  bool warned_ = false;
};

// Works through the images; false if it was interrupted.
bool add_images(const TrainArguments& arguments, ImageStream& stream, FeatureExtractor& extractor,
                VocabularyTrainer& trainer, const std::string& source, Checkpoint& checkpoint) {
  std::size_t position = 0;
  if (!arguments.checkpoint.empty() && fs::exists(arguments.checkpoint)) {
    position = trainer.load(arguments.checkpoint, source);
    print("going on at image {} of {}\n", position, stream.size());
  }
  Progress progress("images", stream.size());
  stream.visit(position, [&](std::size_t index, const ImageStream::Item& item) {
    if (item.first) trainer.start_sequence();
    trainer.add(extractor.extract(item.image, false));
    if (item.photo) {
      add_photo(trainer, extractor, item.image, index, arguments.photo_views);
    }
    position = index + 1;
    progress.update(position, fmt::format("{} words open", trainer.open_words()));
    if (position % kImagesPerCheckpoint == 0) checkpoint.try_to_save(position);
    return !stop_requested();
  });
  progress.finish();
  if (!stop_requested()) return true;
  checkpoint.save(position);
  return false;
}

void require_two_files(const std::string& out, const std::string& checkpoint) {
  std::error_code ignored;
  if (fs::weakly_canonical(out, ignored) != fs::weakly_canonical(checkpoint, ignored)) return;
  throw InputError(
      fmt::format("{}: is both --out and --checkpoint, expected two different files", out));
}

int train(const TrainArguments& arguments) {
  Vocabulary::require_target(arguments.out);
  if (!arguments.checkpoint.empty()) require_two_files(arguments.out, arguments.checkpoint);
  const std::unique_ptr<FeatureExtractor> extractor = make_extractor(arguments.extractor);
  VocabularyTrainer trainer(extractor->traits(), arguments.options);
  ImageStream stream(arguments.sources, arguments.stride);
  const std::string source = describe_training(arguments, extractor->name());
  Checkpoint checkpoint(trainer, arguments.checkpoint, source);
  std::optional<Unsaved> unsaved;
  if (checkpoint.wanted()) unsaved.emplace();
  if (!add_images(arguments, stream, *extractor, trainer, source, checkpoint)) return kInterrupted;

  // The tree is made at one go; from the checkpoint it can be made again.
  checkpoint.try_to_save(stream.size());
  unsaved.reset();
  constexpr std::size_t kSteps = 1000;
  Progress progress("tree", kSteps, Progress::Unit::kShare);
  const Vocabulary vocabulary =
      trainer.finish(trained_name(extractor->name(), arguments.options.method), [&](double share) {
        progress.update(static_cast<std::size_t>(share * kSteps), "grouping words");
      });
  progress.finish();
  vocabulary.save(arguments.out);
  std::error_code ignored;
  if (!arguments.checkpoint.empty()) fs::remove(arguments.checkpoint, ignored);
  const VocabularyInfo info = vocabulary.info();
  print("{}: {} of {} {} from {}, {}\n", arguments.out, counted(info.words, "word"), info.dimension,
        info.binary ? "bytes" : "floats", counted(trainer.images(), "image"),
        counted(static_cast<std::size_t>(info.depth), "level"));
  if (stream.skipped() > 0) {
    warn("images that were skipped: {}; the first: {}", stream.skipped(), stream.first_skipped());
  }
  return kSuccess;
}

void print_info(const std::string& path) {
  const VocabularyInfo info = Vocabulary::load(path).info();
  print("name         {}\n", info.name.empty() ? "none" : info.name);
  print("descriptors  {} {}\n", info.dimension, info.binary ? "bytes" : "floats");
  print("words        {}{}\n", info.words, info.distinct_words ? "" : ", some ids shared");
  print("inner nodes  {}\n", info.inner_nodes);
  print("branching    {}\n", info.branching);
  print("depth        {}\n", info.depth);
  print("weights      {:.4g} to {:.4g}\n", info.min_weight, info.max_weight);
  print("size         {:.2f} MB\n", static_cast<double>(info.bytes) / 1e6);
  print("file         {}\n", !info.mapped        ? "DBoW2 text"
                             : info.has_checksum ? "FBoW with checksum"
                                                 : "FBoW");
}

struct ConvertArguments {
  std::string in;
  std::string out;
  std::string format = "auto";
};

void convert(const ConvertArguments& arguments) {
  std::string format = arguments.format;
  if (format == "auto") format = fs::path(arguments.out).extension() == ".txt" ? "dbow2" : "fbow";
  CommandFiles({arguments.in}).writes("OUT", arguments.out);
  Vocabulary::require_target(arguments.out);
  const Vocabulary vocabulary = Vocabulary::load(arguments.in);
  if (format == "dbow2") {
    write_file_atomically(arguments.out, format_dbow2_text(vocabulary.tree()));
  } else {
    vocabulary.save(arguments.out);
  }
  print("{}: {} words as {}\n", arguments.out, vocabulary.word_count(),
        format == "dbow2" ? "DBoW2 text" : "FBoW");
}

void add_train_command(CLI::App& vocab) {
  const auto arguments = std::make_shared<TrainArguments>();
  VocabularyTrainingOptions& options = arguments->options;
  CLI::App* command = vocab.add_subcommand("train", "train a vocabulary from images");
  command
      ->add_option("SEQUENCE", arguments->sources,
                   "recordings, or folders of photos; SOURCE@FIRST:END[:STEP] takes a part")
      ->required();
  command->add_option("--out", arguments->out, "FBoW file to write")->required();
  command->add_option("--method", options.method, "incremental (the paper's) or kmeans")
      ->check(one_of({"incremental", "kmeans"}))
      ->capture_default_str();
  command->add_option("--branching", options.branching, "most children of a node")
      ->check(range_of<VocabularyTrainingOptions>("branching"))
      ->capture_default_str();
  command->add_option("--depth", options.depth, "most levels, 0 = as needed")
      ->check(range_of<VocabularyTrainingOptions>("depth"))
      ->capture_default_str();
  command->add_option("--words", options.words, "most words, 0 = no limit")
      ->check(range_of<VocabularyTrainingOptions>("words"))
      ->capture_default_str();
  command
      ->add_option("--matched-per-image", options.matched_per_image,
                   "best matched descriptors of an image that join their words")
      ->check(range_of<VocabularyTrainingOptions>("matched_per_image"))
      ->capture_default_str();
  command->add_option("--match-ratio", options.match_ratio, "ratio test of matches, 1 = none")
      ->check(range_of<VocabularyTrainingOptions>("match_ratio"))
      ->capture_default_str();
  command
      ->add_option("--min-observations", options.min_observations,
                   "images that must have seen a word")
      ->check(range_of<VocabularyTrainingOptions>("min_observations"))
      ->capture_default_str();
  command->add_option("--max-open-words", options.max_open_words, "words kept while training")
      ->check(range_of<VocabularyTrainingOptions>("max_open_words"))
      ->capture_default_str();
  command->add_option("--sample-mb", options.sample_mb, "memory for sampled images")
      ->check(range_of<VocabularyTrainingOptions>("sample_mb"))
      ->capture_default_str();
  command->add_option("--seed", options.seed, "seed of the clustering")
      ->check(range_of<VocabularyTrainingOptions>("seed"))
      ->capture_default_str();
  command->add_option("--stride", arguments->stride, "use every n-th image")
      ->check(whole_number(1));
  command
      ->add_option("--photo-views", arguments->photo_views,
                   "changed views that follow each single photo as its neighbours")
      ->check(whole_number(0, 1000))
      ->capture_default_str();
  command->add_option("--checkpoint", arguments->checkpoint,
                      "file for the state of an interrupted training, which a second call with the "
                      "same arguments goes on from");
  add_feature_options(*command, arguments->extractor);
  command->callback([arguments, command] {
    const bool incremental = arguments->options.method == "incremental";
    for (const char* option :
         {"--matched-per-image", "--match-ratio", "--min-observations", "--max-open-words"}) {
      refuse_unused(*command, option, incremental, "with --method incremental");
    }
    if (const int code = train(*arguments); code != kSuccess) throw CLI::RuntimeError(code);
  });
}

}  // namespace

void add_vocab_command(CLI::App& app) {
  CLI::App* vocab = app.add_subcommand("vocab", "train, inspect and convert vocabularies");
  vocab->require_subcommand(1);
  add_train_command(*vocab);

  const auto path = std::make_shared<std::string>();
  CLI::App* info = vocab->add_subcommand("info", "check a vocabulary and say what it is");
  info->add_option("FILE", *path, "FBoW or DBoW2 text file")->required();
  info->callback([path] { print_info(*path); });

  const auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* to = vocab->add_subcommand("convert", "write a vocabulary in another format");
  to->add_option("IN", arguments->in, "FBoW or DBoW2 text file")->required();
  to->add_option("OUT", arguments->out, "file to write")->required();
  to->add_option("--to", arguments->format, "fbow, dbow2 or auto (dbow2 for .txt)")
      ->check(one_of({"auto", "fbow", "dbow2"}))
      ->capture_default_str();
  to->callback([arguments] { convert(*arguments); });
}

}  // namespace dxslam::apps
