// Uses the installed package as a program of someone else would: prints the version that it was built with.
#include <cstdio>

#include "core/base/error.h"
#include "core/base/version.h"

int main() {
    try {
        throw penumbra::Error(penumbra::ErrorKind::Usage, "thrown and caught");
    } catch (const penumbra::Error& error) {
        std::printf("Penumbra %s: %s\n", penumbra::kVersion, error.what());
    }
}
