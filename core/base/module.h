// Modules: parts of Penumbra that are loaded when they are first needed, because what they link would cost every
// process more than all the rest of it (core/image/oiio_module.h).
//
// A module is a shared object. It is looked for in the folder of the program (the build tree), then in the modules'
// folder of the installation that the program lies in (bin/../lib/penumbra), then by the dynamic loader's own rules
// (run path, LD_LIBRARY_PATH): those serve programs of others that are linked with our libraries.
//
// Thread safety: may be called from several threads at once. A module stays loaded to the end of the process.
#pragma once

#include <string>

namespace penumbra {

/// The address of the function `symbol` of the module in `file` ("penumbra_oiio.so"). Throws Error(Configuration) where
/// the module cannot be found or loaded, or has no such function.
void* loadModuleFunction(const std::string& file, const char* symbol);

}  // namespace penumbra
