// ByteReader: the bytes of a file or of a piece of memory, in order, inflated where they are gzip (known by its first
// two bytes, not by the name). Nothing but one block is held, so a file of any size costs 128 KB.
//
// The block is a window onto the stream: fill(n) makes at least n bytes visible from data() on, consume(n) moves on.
// This is the only file pair that uses zlib.
//
// Invariants: available() bytes may be read from data() on, until the next fill(), skip() or move.
//
// Hostile input: an inflated stream may be at most 64 MiB plus 100 times its compressed size long (deflate itself
// allows 1032 times; of 320 real scenes and meshes none needed more than 21); what is damaged, cut short or beyond that
// throws Error(BadData).
//
// Thread safety: none; one instance belongs to one thread.
#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace penumbra {

class ByteReader {
public:
    /// The most bytes that fill() can be asked for.
    static constexpr std::size_t kBlockSize = std::size_t{1} << 17;

    /// A regular file; throws Error(MissingInput) where it is none or cannot be opened.
    static ByteReader open(const std::string& path);
    /// Bytes that outlive the reader; `name` is for messages.
    static ByteReader overMemory(std::string_view bytes, std::string name);

    ByteReader(ByteReader&&) noexcept;
    ByteReader& operator=(ByteReader&&) noexcept;
    ~ByteReader();

    const std::string& name() const { return name_; }
    const char* data() const { return block_.get() + begin_; }
    std::size_t available() const { return end_ - begin_; }
    /// True where n bytes are visible; false where the stream ends before.
    bool fill(std::size_t n) { return available() >= n || refill(n); }
    /// REQUIRES: n <= available().
    void consume(std::size_t n) { begin_ += n; }
    /// Moves on by n bytes of any number; false where the stream ends before.
    bool skip(std::uint64_t n);
    /// An upper bound of the bytes still to come, those visible included: exact for plain files, so that a count that a
    /// header claims can be refused before anything is allocated for it.
    std::uint64_t mostBytesLeft() const;

    /// "zlib 1.2.13", as the library says at run time.
    static std::string libraryVersion();

private:
    struct Source;
    ByteReader(std::unique_ptr<Source> source, std::string name);
    bool refill(std::size_t n);

    std::string name_;
    std::unique_ptr<Source> source_;
    std::unique_ptr<char[]> block_;
    std::size_t begin_ = 0, end_ = 0;
};

}  // namespace penumbra
