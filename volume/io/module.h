#pragma once
// Inside volume/io: libraries that are too large to be loaded at every start sit in modules beside the program.
#include <string>

namespace pith {

/// The function `symbol` of the module `file` ("pith-images.so"). It is looked for beside the object that holds this
/// code, beside the program, and in ../lib/pith of both. Loaded once; it stays until the process ends. `purpose`
/// stands in the message. Errors: IoFailure, saying which file is missing or why it does not load.
void* module_function(const std::string& file, const std::string& symbol, const std::string& purpose);

} // namespace pith
