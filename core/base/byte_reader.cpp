#include "core/base/byte_reader.h"

#include "core/base/text.h"

#include <sys/stat.h>
#include <zlib.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>

namespace penumbra {

namespace {

constexpr std::uint64_t kInflatedAtLeastAllowed = std::uint64_t{64} << 20;
constexpr std::uint64_t kInflatedPerCompressedByte = 100;

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

/// The bytes as they are stored: of an open file, or of memory where there is no file.
class RawBytes {
public:
    RawBytes(std::FILE* file, std::uint64_t size) : file_(file), left_(size) {
        std::setvbuf(file, nullptr, _IONBF, 0);  // ByteReader has the block
    }
    explicit RawBytes(std::string_view memory) : memory_(memory.data()), left_(memory.size()) {}

    /// Up to n bytes; 0 at the end. Never more than the file had when it was opened.
    std::size_t read(char* out, std::size_t n, const std::string& name) {
        n = static_cast<std::size_t>(std::min<std::uint64_t>(n, left_));
        if (n == 0) return 0;
        if (file_) {
            n = std::fread(out, 1, n, file_.get());
            if (n == 0 && std::ferror(file_.get()))
                throw Error(ErrorKind::BadData, name + ": cannot be read: " + std::strerror(errno));
        } else {
            std::memcpy(out, memory_, n);
            memory_ += n;
        }
        left_ = n == 0 ? 0 : left_ - n;  // 0: the file has been cut while it was read
        return n;
    }
    std::uint64_t left() const { return left_; }

    /// Looks at the first two bytes. REQUIRES: nothing has been read.
    bool startsLikeGzip() {
        char magic[2] = {};
        if (file_) {
            // Whatever fails here fails again, and is reported, where the bytes are read.
            if (std::fread(magic, 1, 2, file_.get()) != 2) magic[0] = 0;
            std::rewind(file_.get());
        } else if (left_ >= 2) {
            std::memcpy(magic, memory_, 2);
        }
        return magic[0] == '\x1f' && magic[1] == '\x8b';
    }

private:
    std::unique_ptr<std::FILE, CloseFile> file_;
    const char* memory_ = nullptr;
    std::uint64_t left_;
};

/// Inflates a gzip stream of one or more members.
class Inflater {
public:
    explicit Inflater(std::uint64_t compressedSize)
        : left_(kInflatedAtLeastAllowed + kInflatedPerCompressedByte * compressedSize), input_(new char[kInputSize]) {
        constexpr int kGzipOnly = 16;
        if (inflateInit2(&stream_, MAX_WBITS + kGzipOnly) != Z_OK) throw std::bad_alloc();
    }
    ~Inflater() { inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    std::size_t read(RawBytes& raw, char* out, std::size_t n, const std::string& name) {
        stream_.next_out = reinterpret_cast<Bytef*>(out);
        stream_.avail_out = static_cast<uInt>(n);
        while (stream_.avail_out == n && (stream_.avail_in > 0 || refillInput(raw, name)))
            inflateSome(name);
        const std::size_t produced = n - stream_.avail_out;
        if (produced > left_)
            throw Error(ErrorKind::BadData, name + ": inflates to more than 64 MiB plus 100 times its compressed size");
        left_ -= produced;
        return produced;
    }
    std::uint64_t left() const { return left_; }

private:
    static constexpr std::size_t kInputSize = std::size_t{1} << 16;

    /// False at the end of the last member.
    bool refillInput(RawBytes& raw, const std::string& name) {
        stream_.next_in = reinterpret_cast<Bytef*>(input_.get());
        stream_.avail_in = static_cast<uInt>(raw.read(input_.get(), kInputSize, name));
        if (stream_.avail_in == 0 && !atMemberEnd_)
            throw Error(ErrorKind::BadData, name + ": the gzip data end too early");
        return stream_.avail_in > 0;
    }
    void inflateSome(const std::string& name) {
        if (atMemberEnd_) inflateReset(&stream_);  // another member follows
        const int result = inflate(&stream_, Z_NO_FLUSH);
        atMemberEnd_ = result == Z_STREAM_END;
        if (result == Z_MEM_ERROR) throw std::bad_alloc();
        if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)
            throw Error(ErrorKind::BadData, name + ": the gzip data are damaged" +
                                                (stream_.msg ? std::string(": ") + stream_.msg : std::string()));
    }

    z_stream stream_{};
    std::uint64_t left_;
    std::unique_ptr<char[]> input_;
    bool atMemberEnd_ = false;
};

}  // namespace

struct ByteReader::Source {
    explicit Source(RawBytes bytes) : raw(std::move(bytes)) {
        if (raw.startsLikeGzip()) inflater.emplace(raw.left());
    }

    std::size_t read(char* out, std::size_t n, const std::string& name) {
        return inflater ? inflater->read(raw, out, n, name) : raw.read(out, n, name);
    }
    std::uint64_t left() const { return inflater ? inflater->left() : raw.left(); }

    RawBytes raw;
    std::optional<Inflater> inflater;  // empty: plain bytes
};

ByteReader::ByteReader(std::unique_ptr<Source> source, std::string name)
    : name_(std::move(name)), source_(std::move(source)), block_(new char[kBlockSize]) {}

ByteReader::ByteReader(ByteReader&&) noexcept = default;
ByteReader& ByteReader::operator=(ByteReader&&) noexcept = default;
ByteReader::~ByteReader() = default;

ByteReader ByteReader::open(const std::string& path) {
    struct stat status {};
    // Looked at before it is opened: opening a pipe would wait for its writer.
    std::string name = pathText(path);
    const auto fail = [&](const std::string& reason) { throw Error(ErrorKind::MissingInput, name + ": " + reason); };
    if (::stat(path.c_str(), &status) != 0) fail(std::string("cannot be opened: ") + std::strerror(errno));
    if (!S_ISREG(status.st_mode)) fail("is not a file");
    std::FILE* const file = std::fopen(path.c_str(), "rb");
    if (!file) fail(std::string("cannot be opened: ") + std::strerror(errno));
    RawBytes raw(file, static_cast<std::uint64_t>(status.st_size));
    return ByteReader(std::make_unique<Source>(std::move(raw)), std::move(name));
}

ByteReader ByteReader::overMemory(std::string_view bytes, std::string name) {
    return ByteReader(std::make_unique<Source>(RawBytes(bytes)), std::move(name));
}

std::uint64_t ByteReader::mostBytesLeft() const {
    return available() + source_->left();
}

bool ByteReader::refill(std::size_t n) {
    std::memmove(block_.get(), block_.get() + begin_, available());
    end_ -= begin_;
    begin_ = 0;
    while (end_ < std::min(n, kBlockSize)) {
        const std::size_t got = source_->read(block_.get() + end_, kBlockSize - end_, name_);
        if (got == 0) break;
        end_ += got;
    }
    return available() >= n;
}

bool ByteReader::skip(std::uint64_t n) {
    while (n > available()) {
        n -= available();
        begin_ = end_ = 0;
        if (!refill(1)) return false;
    }
    begin_ += static_cast<std::size_t>(n);
    return true;
}

std::string ByteReader::libraryVersion() {
    return std::string("zlib ") + zlibVersion();
}

}  // namespace penumbra
