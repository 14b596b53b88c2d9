// pith-bench: runs rows of the benchmark table and prints them. `./do bench` builds it and starts it.
#include "bench/row.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

namespace {

using namespace pith::bench;

std::string shown(double value) { return fmt::format("{:.4g}", value); }

/// Width on the screen: bytes that start a character.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

void print_line(const std::vector<std::string>& cells) {
  static constexpr std::size_t widths[] = {24, 12, 5, 12, 28};
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += cells[i];
    if (i < std::size(widths))
      line.append(std::max<std::size_t>(1, widths[i] - std::min(widths[i], width_of(cells[i]))), ' ');
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  std::puts(line.c_str());
  std::fflush(stdout);
}

void write_whole(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path beside = path.string() + ".part";
  {
    std::ofstream file(beside, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw std::runtime_error(path.string() + ": cannot be written");
  }
  std::filesystem::rename(beside, path);
}

} // namespace

int main(int count, char** arguments) {
  CLI::App app("Runs rows of the benchmark table", "./do bench");
  std::string only, json_path;
  Settings settings;
  bool list = false;
  app.add_option("--only", only, "run the rows whose name matches this regular expression");
  app.add_option("--json", json_path, "write the rows to this file");
  app.add_option("--repeat", settings.repeat, "measurements per row (default: the row's own number, 3 or more)")
      ->check(CLI::PositiveNumber);
  app.add_flag("--list", list, "print the names of the rows and stop");
  CLI11_PARSE(app, count, arguments);

  settings.source = PITH_SOURCE_DIR;
  settings.shared_data = PITH_SHARED_DATA;
  settings.programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();

  std::vector<Row> rows;
  for (auto* group : {mesh_rows, field_rows, lap_rows, sample_rows, cut_rows, view_rows, build_rows})
    for (Row& row : group()) rows.push_back(std::move(row));
  if (!only.empty()) {
    try {
      const std::regex pattern(only);
      std::erase_if(rows, [&](const Row& row) { return !std::regex_search(row.name, pattern); });
    } catch (const std::regex_error& error) {
      std::fprintf(stderr, "pith-bench: --only %s is not a regular expression: %s\n", only.c_str(), error.what());
      return 2;
    }
  }
  if (list) {
    for (const Row& row : rows) std::puts(row.name.c_str());
    return 0;
  }

  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  int failures = 0;
  print_line({"name", "value", "unit", "target", "peer", "note"});
  for (const Row& row : rows) {
    try {
      const Measured measured = row.run(settings);
      nlohmann::ordered_json entry = {
          {"name", row.name}, {"value", measured.value}, {"unit", row.unit}, {"target", row.target}};
      std::string peer;
      if (measured.peer_value) {
        entry["peer"] = measured.peer;
        entry["peer_value"] = *measured.peer_value;
        peer = measured.peer + " " + shown(*measured.peer_value);
      }
      entry["note"] = measured.note;
      all.push_back(std::move(entry));
      print_line({row.name, shown(measured.value), row.unit, row.target, peer, measured.note});
    } catch (const Skipped& reason) {
      print_line({row.name, "skipped", "", "", "", reason.what()});
    } catch (const std::exception& error) {
      ++failures;
      print_line({row.name, "FAILED", "", "", "", error.what()});
    }
  }
  try {
    if (!json_path.empty()) write_whole(json_path, all.dump(2) + "\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pith-bench: %s\n", error.what());
    return 1;
  }
  return failures ? 1 : 0;
}
