#include "volume/io/module.h"

#include "volume/base/error.h"

#include <dlfcn.h>
#include <filesystem>
#include <vector>

namespace pith {

void* module_function(const std::string& file, const std::string& symbol, const std::string& purpose) {
  std::vector<std::filesystem::path> folders;
  std::error_code error;
  const auto add = [&](const std::filesystem::path& object) {
    const auto folder = std::filesystem::weakly_canonical(object, error).parent_path();
    if (error || folder.empty()) return;
    folders.push_back(folder);
    folders.push_back(folder.parent_path() / "lib" / "pith");
  };
  Dl_info about{};
  if (::dladdr(reinterpret_cast<void*>(&module_function), &about) != 0 && about.dli_fname) add(about.dli_fname);
  add(std::filesystem::read_symlink("/proc/self/exe", error));

  for (const auto& folder : folders) {
    const auto path = folder / file;
    if (!std::filesystem::exists(path, error)) continue;
    void* module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!module) {
      const char* reason = ::dlerror();
      throw IoFailure(path.string(), "needed for " + purpose + ", does not load: " + (reason ? reason : "unknown"));
    }
    if (void* function = ::dlsym(module, symbol.c_str())) return function;
    throw IoFailure(path.string(), "belongs to another version of pith; build or install pith again");
  }
  throw IoFailure(file, "needed for " + purpose + ", is not beside the program" +
                            (folders.empty() ? std::string() : " (" + folders.front().string() + ")") +
                            "; build or install pith again");
}

} // namespace pith
