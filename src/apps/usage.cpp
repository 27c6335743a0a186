// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "features/extractor_factory.h"
#include "io/primitives/text_file.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam::apps {
namespace {

std::optional<std::int64_t> parse_whole(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

const CLI::App* find_command(const CLI::App& app, const std::string& word) {
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->check_name(word)) return command;
  }
  return nullptr;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

const CLI::Option* find_option(const CLI::App& app, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  for (const CLI::Option* option : app.get_options()) {
    if (option->check_name(name)) return option;
  }
  return nullptr;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

CLI::ParseError unknown_word(const std::string& word, const char* what,
                             const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(word.substr(0, word.find('=')), names);
  std::string text = fmt::format("{} is no {}", in_quotes(word), what);
  if (!nearest.empty()) {
    text += fmt::format(", expected {}", nearest);
  } else if (std::string_view(what) == "command") {
    text += fmt::format(", expected one of {}", fmt::join(names, ", "));
  }
  return {text, CLI::ExitCodes::InvalidError};
}

// All behind `--` are arguments, whatever they look like.
bool is_behind_dashes(const std::string& word, int argc, const char* const* argv) {
  const auto end = argv + argc;
  const auto dashes = std::find(argv, end, std::string_view("--"));
  return std::find(argv, dashes, word) == dashes && std::find(dashes, end, word) != end;
}

// The first of the words left over that looks like an option, or else the first. CLI11 may give
// them in any order.
std::string first_unknown(const std::vector<std::string>& words, const CLI::App& command) {
  const auto is_word = [](const std::string& word) { return word != "--"; };
  for (const std::string& word : words) {
    if (word.size() > 1 && is_word(word) && word.front() == '-' &&
        find_option(command, word) == nullptr)
      return word;
  }
  const auto first = std::find_if(words.begin(), words.end(), is_word);
  return first == words.end() ? std::string() : *first;
}

}  // namespace

CLI::Validator one_of(std::vector<std::string> words) {
  return {[words = std::move(words)](std::string& text) {
            if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
            const std::string nearest = nearest_name(text, words);
            return nearest.empty()
                       ? fmt::format("{} is none of {}", in_quotes(text), fmt::join(words, ", "))
                       : fmt::format("{} is no choice, expected {}", in_quotes(text), nearest);
          },
          "", ""};
}

CLI::Validator accepted_by(std::function<void(const std::string&)> take) {
  return {[take = std::move(take)](std::string& text) {
            try {
              take(text);
              return std::string();
            } catch (const InputError& error) {
              return std::string(error.what());
            }
          },
          "", ""};
}

CLI::Validator svg_file() {
  return {[](std::string& text) {
            static const std::vector<std::string> others = {".png", ".jpg",  ".jpeg", ".pdf",
                                                            ".ps",  ".eps",  ".gif",  ".bmp",
                                                            ".tif", ".tiff", ".webp"};
            std::string ending = std::filesystem::path(text).extension().string();
            std::transform(ending.begin(), ending.end(), ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
            if (std::find(others.begin(), others.end(), ending) == others.end())
              return std::string();
            return fmt::format("{}: pictures are written as SVG, expected a name that ends in .svg",
                               in_quotes(text));
          },
          "", ""};
}

CLI::Validator recording_format() {
  std::vector<std::string> names = sequence_formats();
  names.insert(names.begin(), "auto");
  return one_of(std::move(names));
}

CLI::Validator extractor_name() { return accepted_by(require_known_extractor); }

CLI::Validator precision_name() { return one_of({"auto", "f32", "bf16", "int8"}); }

CLI::Validator whole_number(std::int64_t min, std::int64_t max) {
  return {[min, max](std::string& text) {
            const std::optional<std::int64_t> value = parse_whole(text);
            if (value && *value >= min && *value <= max) return std::string();
            return fmt::format("{} is no whole number from {} to {}", in_quotes(text), min, max);
          },
          "", ""};
}

CLI::Validator number(double min, double max) {
  return {[min, max](std::string& text) {
            const std::optional<double> value = parse_number(text);
            if (value && *value >= min && *value <= max) return std::string();
            return fmt::format("{} is no number from {:g} to {:g}", in_quotes(text), min, max);
          },
          "", ""};
}

CLI::Validator low_light_gain() { return number(0.001, 1.0); }

void refuse_unused(const CLI::App& command, const char* option, bool used, const char* meant) {
  if (used || command.count(option) == 0) return;
  throw InputError(fmt::format("option {} has no use here, expected it {}", option, meant));
}

void refuse_empty_values(CLI::App& app) {
  const CLI::Validator not_empty(
      [](std::string& text) { return text.empty() ? std::string("its value is empty") : ""; }, "",
      "");
  for (CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_min() > 0) option->check(not_empty);
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_values(*command);
}

void require_known_words(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* at = &app;
  for (int i = 1; i < argc && at->get_require_subcommand_min() > 0; ++i) {
    const std::string word = argv[i];
    if (!word.empty() && word.front() == '-') {
      if (find_option(*at, word) != nullptr) return;  // help or the version
      throw unknown_word(word, "option", option_names(*at));
    }
    const CLI::App* const command = find_command(*at, word);
    if (command == nullptr) throw unknown_word(word, "command", command_names(*at));
    at = command;
  }
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--") return;
    if (word.size() < 4 || !word.starts_with("--") || !word.ends_with('=')) continue;
    throw CLI::ParseError(fmt::format("{}: its value is empty", word.substr(0, word.size() - 1)),
                          CLI::ExitCodes::ValidationError);
  }
}

std::string usage_problem(const CLI::App& app, int argc, const char* const* argv,
                          const CLI::ParseError& error) {
  // By the words, as an error may come before they are read.
  const CLI::App* command = &app;
  std::string help = app.get_name();
  for (int i = 1; i < argc; ++i) {
    const CLI::App* const next = find_command(*command, argv[i]);
    if (next == nullptr) break;
    command = next;
    help += " " + next->get_name();
  }
  std::string problem = error.what();
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ArgumentMismatch) &&
      problem.find(": At Most 1 required") != std::string::npos) {
    const std::string name = problem.substr(0, problem.find(':'));
    problem = name + (name.starts_with('-') ? ": given more than once"
                                            : ": more than one given, expected one");
  }
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    const std::vector<std::string> words = app.remaining(true);
    if (const std::string word = first_unknown(words, *command); !word.empty()) {
      const bool is_option = word.front() == '-' && !is_behind_dashes(word, argc, argv);
      problem = is_option ? unknown_word(word, "option", option_names(*command)).what()
                          : fmt::format("{} is one argument too many", in_quotes(word));
    }
  }
  return fmt::format("{}; see {} --help", problem, help);
}

}  // namespace dxslam::apps
