#pragma once
// Real meshes, images and volumes that tests may read where the build was told of them (PITH_SHARED_DATA).
#include <filesystem>
#include <string>

namespace pith::testing {

/// The path of a shared file, or an empty path where there is none: then the caller skips, saying so.
inline std::filesystem::path shared_data(const std::string& name) {
  const std::filesystem::path root = PITH_SHARED_DATA;
  if (root.empty() || !std::filesystem::exists(root / name)) return {};
  return root / name;
}

} // namespace pith::testing

#define PITH_REQUIRE_SHARED(variable, name)                                                                            \
  const std::filesystem::path variable = pith::testing::shared_data(name);                                             \
  if (variable.empty()) GTEST_SKIP() << "no shared data: configure with -DPITH_SHARED_DATA=FOLDER to run with " << name
