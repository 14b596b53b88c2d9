#pragma once
// One row of the benchmark table, and how rows are timed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace pith::bench {

/// What the user asked for, and where things are.
struct Settings {
  int repeat = 0;                    ///< measurements per row; 0: as many as the row thinks right, at least 3
  std::filesystem::path source;      ///< root of the checkout
  std::filesystem::path programs;    ///< folder of pith and its helpers
  std::filesystem::path shared_data; ///< real meshes; may be empty

  int times(int usual) const { return repeat > 0 ? repeat : usual; }
};

struct Measured {
  double value = 0;
  std::string note;
  std::string peer = {}; ///< who did the same work in the same call; empty: nobody
  std::optional<double> peer_value = {};
};

/// Thrown by a row that cannot run here; the message says what is missing.
struct Skipped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Row {
  std::string name;
  std::string unit;
  std::string target; ///< in words: "≤ 0.3"; empty: none
  std::function<Measured(const Settings&)> run;
};

inline double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Seconds that the calling thread has computed: what a busy machine does not stretch.
inline double thread_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// The median time of `work` over `times` runs after one that does not count; `prepare` goes before each, untimed.
inline double median_seconds(int times, const std::function<void()>& prepare, const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int i = 0; i <= times; ++i) {
    if (prepare) prepare();
    const double taken = seconds_of(work);
    if (i > 0) seconds.push_back(taken);
  }
  return median(seconds);
}

/// Keeps the compiler from dropping work whose result nobody reads.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

std::vector<Row> build_rows();  ///< build/*, info/*
std::vector<Row> mesh_rows();   ///< tetrahedralize/*
std::vector<Row> lap_rows();    ///< lap/*
std::vector<Row> field_rows();  ///< rbf/*
std::vector<Row> sample_rows(); ///< sample/*
std::vector<Row> cut_rows();    ///< cut/*
std::vector<Row> view_rows();   ///< view/*

} // namespace pith::bench
