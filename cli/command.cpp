#include "cli/command.h"

#include "volume/base/error.h"

#include <CLI/Error.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <sys/resource.h>
#include <unistd.h>

namespace pith::cli {

void ProgressLine::show(const std::string& what, double fraction, const std::string& line) {
  if (kind_ == Kind::none) return;
  const std::int64_t now =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
          .count();
  if (kind_ == Kind::lines) return tell(what, line, now);
  if (shown_ && now - last_ms_ < 50) return;
  last_ms_ = now;
  constexpr int width = 30;
  const int filled = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * width);
  std::fprintf(stderr, "\r\033[K%-14s [%s%s] %3d %%", what.c_str(), std::string(filled, '#').c_str(),
               std::string(width - filled, ' ').c_str(), static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0)));
  std::fflush(stderr);
  shown_ = true;
}

void ProgressLine::tell(const std::string& what, const std::string& line, std::int64_t now) {
  constexpr std::int64_t long_work = 1000; // ms
  const auto [begun, fresh] = begun_.try_emplace(what, now);
  if (fresh || begun->second < 0 || now - begun->second < long_work) return;
  begun->second = -1;
  std::fprintf(stderr, "%s …\n", (line.empty() ? what : line).c_str());
}

void ProgressLine::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

Progress Session::progress(const std::string& what, const std::string& line) const {
  return [this, what, line](double fraction) {
    if (progress_line) progress_line->show(what, fraction, line);
    return !cancelled();
  };
}

void Session::stop_if_asked() const {
  if (cancelled()) throw Cancelled();
}

void Session::say(const std::string& line) const {
  if (json || quiet) return;
  if (progress_line) progress_line->clear();
  std::printf("%s\n", line.c_str());
}

void Session::print(const Json& object) const {
  if (!json) return;
  if (progress_line) progress_line->clear();
  printed = true;
  std::printf("%s\n", object.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

std::array<int, 2> size_of(const std::string& option, const std::string& text, int least, int most) {
  std::array<int, 2> size{};
  int end = 0;
  const bool read =
      std::sscanf(text.c_str(), "%5dx%5d%n", &size[0], &size[1], &end) == 2 && end == static_cast<int>(text.size());
  if (!read || std::min(size[0], size[1]) < least || std::max(size[0], size[1]) > most)
    throw CLI::ValidationError(option, "'" + text + "' is not WIDTHxHEIGHT, such as 800x600");
  return size;
}

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

void check_output(const std::filesystem::path& path, std::initializer_list<const char*> extensions) {
  const std::string extension = extension_of(path);
  if (extensions.size() > 0 &&
      std::none_of(extensions.begin(), extensions.end(), [&](const char* one) { return extension == one; })) {
    std::string all;
    for (const char* one : extensions) all += std::string(all.empty() ? "." : ", .") + one;
    throw InvalidInput(path.string(), extension.empty() ? "has no extension" : "has the extension ." + extension,
                       "name a file that ends in " + all);
  }
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw IoFailure(path.string(), "is a folder; name a file");
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, error))
    throw IoFailure(path.string(), "cannot be written: its folder does not exist; make the folder first");
  if (::access(folder.c_str(), W_OK) != 0)
    throw IoFailure(path.string(), "cannot be written: no permission in its folder; choose another");
}

void add_displacement_options(CLI::App& app, DisplaceOptions& options) {
  app.add_option("--displacement", options.scale,
                 "where the skin's material has a relief: factor on its height; 0: the smooth skin")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--displacement-edge", options.max_edge,
                 "longest edge of the skin's triangles then, mm; 0: longest extent / 400")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

std::string nearest_name(const std::string& word, const std::vector<std::string>& names) {
  std::string best;
  std::size_t least = 1 + std::max<std::size_t>(1, word.size() / 2); // a word of which more is wrong is another one
  for (const std::string& name : names) {
    // Levenshtein's distance, row by row.
    std::vector<std::size_t> row(name.size() + 1);
    for (std::size_t j = 0; j <= name.size(); ++j) row[j] = j;
    for (std::size_t i = 0; i < word.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i + 1;
      for (std::size_t j = 0; j < name.size(); ++j) {
        const std::size_t replaced = diagonal + (word[i] != name[j]);
        diagonal = row[j + 1];
        row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
      }
    }
    if (row.back() < least) least = row.back(), best = name;
  }
  return best;
}

std::vector<double> numbers_of(const std::string& option, const std::string& text, std::size_t count) {
  std::vector<double> result;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at <= end) {
    double number = 0;
    if (at < end && *at == '+') ++at;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || !std::isfinite(number)) break;
    result.push_back(number);
    at = next;
    if (at == end || *at != ',') break;
    ++at;
  }
  if (at != end || result.size() != count)
    throw CLI::ValidationError(option,
                               "'" + text + "' is not " + std::to_string(count) + " numbers with commas between");
  return result;
}

void refuse_odd_values(CLI::App& verb) {
  for (CLI::Option* option : verb.get_options()) {
    if (option->get_items_expected_max() == 0) continue; // a flag
    const std::string type = option->get_type_name();
    const bool real = type.starts_with("FLOAT"), count = type.starts_with("UINT");
    const auto refused = [real, count](std::string& text) -> std::string {
      if (text.empty()) return "the value is empty";
      if (count && text.front() == '-') return "'" + text + "' is below 0";
      double number = 0;
      const char* const first = text.data() + (text.front() == '+' ? 1 : 0);
      const auto [end, error] = std::from_chars(first, text.data() + text.size(), number);
      if (real && error == std::errc() && !std::isfinite(number)) return "'" + text + "' is not a finite number";
      return {};
    };
    option->check(CLI::Validator(refused, ""));
  }
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::uint64_t helper_peak_memory_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

} // namespace pith::cli
