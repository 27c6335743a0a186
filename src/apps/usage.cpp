// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/usage.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/primitives/text_file.h"

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

}  // namespace

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

void refuse_empty_values(CLI::App& app) {
  const CLI::Validator not_empty(
      [](std::string& text) { return text.empty() ? std::string("its value is empty") : ""; }, "",
      "");
  for (CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_min() > 0) option->check(not_empty);
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_values(*command);
}

void require_known_commands(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* at = &app;
  for (int i = 1; i < argc && at->get_require_subcommand_min() > 0; ++i) {
    const std::string word = argv[i];
    if (!word.empty() && word.front() == '-') return;  // help, or an error that names itself
    const CLI::App* const command = find_command(*at, word);
    if (command == nullptr) {
      const std::vector<std::string> names = command_names(*at);
      const std::string nearest = nearest_name(word, names);
      throw CLI::ParseError(
          fmt::format("{} is no command, expected {}", in_quotes(word),
                      nearest.empty() ? fmt::format("one of {}", fmt::join(names, ", "))
                                      : fmt::format("{}?", nearest)),
          CLI::ExitCodes::ExtrasError);
    }
    at = command;
  }
}

std::string command_line_of(const CLI::App& app) {
  const std::vector<CLI::App*> used = static_cast<const CLI::App&>(app).get_subcommands();
  return used.empty() ? app.get_name() : app.get_name() + " " + command_line_of(*used.back());
}

}  // namespace dxslam::apps
