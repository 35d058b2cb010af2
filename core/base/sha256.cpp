#include "core/base/sha256.h"

#include "core/base/error.h"
#include "core/base/text.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

namespace penumbra {
namespace {

void check(int result) {
    if (result != 1) throw Error(ErrorKind::Internal, "OpenSSL refuses to make a SHA-256");
}

[[noreturn]] void failReading(const std::string& path) {
    throw Error(ErrorKind::MissingInput, pathText(path) + ": cannot be read: " + std::strerror(errno));
}

}  // namespace

struct Sha256::State {
    struct Free {
        void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
    };
    std::unique_ptr<EVP_MD_CTX, Free> context{EVP_MD_CTX_new()};
};

Sha256::Sha256() : state_(new State) {
    check(state_->context ? EVP_DigestInit_ex(state_->context.get(), EVP_sha256(), nullptr) : 0);
}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::add(const void* data, std::size_t size) {
    check(EVP_DigestUpdate(state_->context.get(), data, size));
}

std::string Sha256::hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
    unsigned size = 0;
    check(EVP_DigestFinal_ex(state_->context.get(), digest.data(), &size));
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
        text += kDigits[digest[i] >> 4];
        text += kDigits[digest[i] & 15];
    }
    return text;
}

std::string Sha256::libraryVersion() {
    return std::string("OpenSSL ") + OpenSSL_version(OPENSSL_VERSION_STRING);
}

std::string sha256OfBytes(std::string_view bytes) {
    Sha256 digest;
    digest.add(bytes);
    return digest.hex();
}

std::string sha256OfFile(const std::string& path) {
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
    if (!file) failReading(path);
    Sha256 digest;
    std::vector<char> block(std::size_t{1} << 18);
    while (const std::size_t got = std::fread(block.data(), 1, block.size(), file.get()))
        digest.add(block.data(), got);
    if (std::ferror(file.get())) failReading(path);
    return digest.hex();
}

}  // namespace penumbra
