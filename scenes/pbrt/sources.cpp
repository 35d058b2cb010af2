#include "scenes/pbrt/sources.h"

#include "core/base/byte_reader.h"
#include "core/base/sha256.h"

#include <sys/stat.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace penumbra::pbrt {

namespace {

constexpr std::size_t kMostOfPath = 1000;  // bytes of a path that a message shows

/// The whole text; a NUL byte ends the reading at once, so that a huge file that is no text costs nothing.
std::string readText(ByteReader reader, std::uint64_t expectedSize) {
    constexpr std::uint64_t kMostReserved = std::uint64_t{256} << 20;
    std::string text;
    text.reserve(static_cast<std::size_t>(std::min(expectedSize, kMostReserved)));
    while (reader.fill(1)) {
        const bool bad = std::memchr(reader.data(), '\0', reader.available()) != nullptr;
        text.append(reader.data(), reader.available());
        reader.consume(reader.available());
        if (bad) break;
    }
    return text;
}

std::string readStandardInput() {
    std::string bytes;
    std::vector<char> block(std::size_t{1} << 16);
    while (const std::size_t got = std::fread(block.data(), 1, block.size(), stdin))
        bytes.append(block.data(), got);
    if (std::ferror(stdin)) throw Error(ErrorKind::MissingInput, "standard input cannot be read");
    return bytes;
}

}  // namespace

std::uint32_t Sources::fileIndex(const std::string& name) {
    const auto [entry, isNew] = fileIndices_.emplace(name, static_cast<std::uint32_t>(scene_.files.size()));
    if (isNew) scene_.files.push_back(name);
    return entry->second;
}

void Sources::noteDigest(std::uint32_t file, std::string_view text) {
    scene_.digests.resize(scene_.files.size());
    if (scene_.digests[file].empty()) scene_.digests[file] = sha256OfBytes(text);
}

void Sources::openText(std::string_view text, const std::string& name) {
    const std::uint32_t file = fileIndex(name);
    checkEncoding(text, file);
    noteDigest(file, text);
    open_.push_back(std::make_unique<Source>(std::string(), text, file));
}

void Sources::openStandardInput() {
    const std::uint32_t file = fileIndex("(standard input)");
    const std::string bytes = readStandardInput();
    std::string text = readText(ByteReader::overMemory(bytes, scene_.files[file]), bytes.size());
    checkEncoding(text, file);
    noteDigest(file, text);
    open_.push_back(std::make_unique<Source>(std::move(text), std::string_view(), file));
}

/// Gives the errors of `work` that have no place (of a damaged gzip file, of a path that is not allowed) this one.
template <class Work>
void Sources::atPlace(SourcePosition where, const Work& work) {
    try {
        work();
    } catch (const ErrorAt&) {
        throw;
    } catch (const Error& e) {
        throw ErrorAt(where, e.what(), e.kind());
    }
}

void Sources::openTopFile(const std::string& path) {
    const SourcePosition where{fileIndex(path), 0, 0};
    atPlace(where, [&] { checkInsideRoot(scene_.root, path); });
    push(path, statusOf(path, where), {});
}

void Sources::include(const std::string& name, SourcePosition where) {
    atPlace(where, [&] {
        const std::string path = resolvePath(scene_, name);
        const FileStatus status = statusOf(path, where);
        checkNesting(status.identity, name, where);
        push(path, status, where);
    });
}

Sources::FileStatus Sources::statusOf(const std::string& path, SourcePosition where) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0)
        throw ErrorAt(where, "the file " + quote(path, kMostOfPath) + " cannot be opened: " + std::strerror(errno),
                      ErrorKind::MissingInput);
    if (S_ISDIR(status.st_mode))
        throw ErrorAt(where, "expected a file, but " + quote(path, kMostOfPath) + " is a folder");
    return {{status.st_dev, status.st_ino}, static_cast<std::uint64_t>(status.st_size)};
}

/// The file is checked when it is open, so that the error tells how it came to be included.
void Sources::push(const std::string& path, const FileStatus& status, SourcePosition where) {
    const std::uint32_t file = fileIndex(path);
    std::string text = readText(ByteReader::open(path), status.size);
    chargeText(status.identity, text.size(), where);
    open_.push_back(std::make_unique<Source>(std::move(text), std::string_view(), file));
    open_.back()->includedAt = where;
    open_.back()->identity = status.identity;
    checkEncoding(open_.back()->text, file);
    noteDigest(file, open_.back()->text);
}

void Sources::checkNesting(const Identity& identity, const std::string& name, SourcePosition where) const {
    const bool inside = std::any_of(open_.begin(), open_.end(), [&](const auto& s) { return s->identity == identity; });
    if (inside)
        throw ErrorAt(
            where, "the file " + quote(name, kMostOfPath) + " is being read already: it would include itself for ever");
    if (open_.size() >= kDeepest)
        throw ErrorAt(where, "files are included more than " + std::to_string(kDeepest) + " deep");
}

void Sources::chargeText(const Identity& identity, std::uint64_t bytes, SourcePosition where) {
    (seen_.insert(identity).second ? distinctBytes_ : repeatedBytes_) += bytes;
    if (++filesOpened_ > kMostFiles)
        throw ErrorAt(where, "more than " + std::to_string(kMostFiles) + " files are included");
    if (repeatedBytes_ > kRepeatedAllowed + kRepeats * distinctBytes_)
        throw ErrorAt(where,
                      "files are included again and again, " + std::to_string(repeatedBytes_ >> 20) + " MiB by now");
}

std::size_t Sources::beginPart(const std::string& name, SourcePosition where) {
    include(name, where);
    return std::exchange(floor_, open_.size());
}

void Sources::endPart(std::size_t outerFloor) {
    peeked_.reset();  // the End of the part
    open_.resize(floor_ - 1);
    floor_ = outerFloor;
}

const Token& Sources::peek() {
    while (!peeked_) {
        const Token token = open_.back()->lexer.next();
        if (token.kind != TokenKind::End || open_.size() == floor_)
            peeked_ = token;
        else
            open_.pop_back();
    }
    return *peeked_;
}

Token Sources::next() {
    const Token token = peek();
    peeked_.reset();
    return token;
}

std::string Sources::includeChain() const {
    std::string chain;
    for (auto source = open_.rbegin(); source != open_.rend() && (*source)->includedAt.line > 0; ++source)
        chain += ", included from " + scene_.position((*source)->includedAt);
    return chain;
}

}  // namespace penumbra::pbrt
