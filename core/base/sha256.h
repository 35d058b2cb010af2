// SHA-256 of bytes and files: what tells whether two scenes are one. With sha256.cpp the only file that knows OpenSSL.
//
// Errors: Error(MissingInput) where a file cannot be read, Error(Internal) where OpenSSL refuses.
// Thread safety: the free functions may be called from several threads at once; one Sha256 belongs to one thread.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace penumbra {

class Sha256 {
public:
    Sha256();
    ~Sha256();
    Sha256(Sha256&&) noexcept;
    Sha256& operator=(Sha256&&) noexcept;

    void add(const void* data, std::size_t size);
    void add(std::string_view bytes) { add(bytes.data(), bytes.size()); }
    /// 64 lower-case hexadecimal digits. Ends the digest: nothing may be added afterwards.
    std::string hex();

    /// "OpenSSL 3.0.17", as the library says at run time.
    static std::string libraryVersion();

private:
    struct State;
    std::unique_ptr<State> state_;
};

std::string sha256OfBytes(std::string_view bytes);
/// Of a file's bytes as they are (not inflated), read in blocks.
std::string sha256OfFile(const std::string& path);

}  // namespace penumbra
