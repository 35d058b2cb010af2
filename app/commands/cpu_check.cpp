// The check that this processor can run Penumbra, made before anything else of the program runs.
//
// The rest of the program is compiled for x86-64-v3 (AVX2, FMA, BMI ...), static constructors included; on an older
// processor the first of those instructions would end it with a bare "illegal instruction". This file alone is compiled
// for any x86-64 (see CMakeLists.txt) and runs from .preinit_array: after the dynamic linker's work, before every
// constructor of the program and of its libraries. At that point neither iostreams nor, for certain, stdio are up, so
// it uses system calls only, and no inline function of a library header, of which the linker might keep a copy that was
// compiled for AVX2 elsewhere.
//
// Thread safety: runs once, before there are threads.
#include <cpuid.h>
#include <unistd.h>

namespace {

constexpr int kConfigurationExit = 78;  // EX_CONFIG of sysexits.h, as ErrorKind::Configuration

struct CpuidLeaf {
    unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
};

CpuidLeaf cpuid(unsigned leaf) {
    CpuidLeaf result;
    __get_cpuid_count(leaf, 0, &result.eax, &result.ebx, &result.ecx, &result.edx);  // leaves zeros where unsupported
    return result;
}

/// The operating system saves the upper halves of the YMM registers (XCR0, bits 1 and 2).
bool savesYmmRegisters() {
    constexpr unsigned kSseAndYmm = 0x6;
    unsigned low = 0, high = 0;
    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return (low & kSseAndYmm) == kSseAndYmm;
}

/// x86-64-v3, as the x86-64 psABI lists it.
bool supportsX86_64V3() {
    constexpr unsigned kLeaf1 = bit_SSE3 | bit_SSSE3 | bit_FMA | bit_CMPXCHG16B | bit_SSE4_1 | bit_SSE4_2 | bit_MOVBE |
                                bit_POPCNT | bit_OSXSAVE | bit_AVX | bit_F16C;
    constexpr unsigned kLeaf7 = bit_BMI | bit_AVX2 | bit_BMI2;
    constexpr unsigned kLzcnt = 1u << 5;  // gcc's bit_LZCNT and clang's bit_ABM are one bit under two names
    return (cpuid(1).ecx & kLeaf1) == kLeaf1 && savesYmmRegisters() && (cpuid(7).ebx & kLeaf7) == kLeaf7 &&
           (cpuid(0x80000001u).ecx & kLzcnt) != 0;
}

void checkProcessor(int, char**, char**) {
    if (supportsX86_64V3()) return;
    constexpr char kMessage[] =
        "penumbra: this processor lacks AVX2 (or another part of x86-64-v3: FMA, BMI1, BMI2, F16C, LZCNT, MOVBE),\n"
        "which Penumbra is built for. Processors from 2013 (Intel Haswell) and 2015 (AMD Excavator) on have it;\n"
        "in a virtual machine, let the guest see the host's processor.\n";
    // Nothing can be done about a message that cannot be written.
    [[maybe_unused]] const auto written = write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
    _exit(kConfigurationExit);
}

__attribute__((section(".preinit_array"), used)) void (*const kCheckProcessor)(int, char**, char**) = checkProcessor;

}  // namespace
