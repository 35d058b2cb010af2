#include "core/base/atomic_file.h"

#include "core/base/text.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <random>
#include <utility>

namespace penumbra {
namespace {

[[noreturn]] void fail(ErrorKind kind, const std::string& path, const std::string& action, int reason) {
    throw Error(kind, fmt::format("{}: {}: {}", pathText(path), action, std::strerror(reason)));
}

[[noreturn]] void failAt(std::uint64_t byte, const std::string& path) {
    const int reason = errno;
    fail(ErrorKind::CannotWrite, path, fmt::format("cannot write from byte {} on", byte), reason);
}

/// Calls a system function again for as long as a signal interrupts it.
template <class Call>
auto uninterrupted(const Call& call) {
    auto result = call();
    while (result == -1 && errno == EINTR)
        result = call();
    return result;
}

/// Writes all bytes, in as many pieces as the system takes; returns how many were written, fewer only with errno set.
template <class WriteSome>
std::size_t writeAll(const char* data, std::size_t size, const WriteSome& writeSome) {
    std::size_t done = 0;
    while (done < size) {
        const ssize_t n = uninterrupted([&] { return writeSome(data + done, size - done, done); });
        if (n < 0) break;
        if (n == 0) {  // no progress and no reason given: never loop on it
            errno = EIO;
            break;
        }
        done += std::size_t(n);
    }
    return done;
}

/// Whether the folder's entry itself reached the disk cannot be asked of every file system: those say EINVAL or
/// ENOTSUP.
void syncFolder(const std::string& folder, const std::string& path) {
    const int descriptor = uninterrupted([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
    if (descriptor < 0) return;  // a folder that may be written but not read
    const int result = uninterrupted([&] { return ::fsync(descriptor); });
    const int reason = errno;
    ::close(descriptor);
    if (result != 0 && reason != EINVAL && reason != ENOTSUP && reason != EROFS)
        fail(ErrorKind::CannotWrite, path, "cannot sync its folder", reason);
}

std::string folderOf(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    if (slash == std::string::npos) return ".";
    return slash == 0 ? "/" : path.substr(0, slash);
}

/// What the names of this machine's temporary files for that target begin with; then come process and a random number.
std::string temporaryPrefix(const std::string& target) {
    constexpr std::size_t kLongestPart = 100;  // names may have 255 bytes
    char host[64] = "";
    ::gethostname(host, sizeof host - 1);
    return fmt::format(".{}.tmp.{}.", target.substr(target.rfind('/') + 1).substr(0, kLongestPart), host);
}

std::string temporaryName(const std::string& target) {
    std::random_device random;
    return fmt::format("{}/{}{}.{:08x}", folderOf(target), temporaryPrefix(target), ::getpid(), random());
}

/// The process in "123.0123abcd"; 0 where it is none.
pid_t processIn(std::string_view rest) {
    constexpr std::size_t kDigits = 8;
    pid_t process = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), process);
    const std::string_view random(end, std::size_t(rest.data() + rest.size() - end));
    const bool isOurs = error == std::errc() && process > 0 && random.size() == 1 + kDigits && random[0] == '.' &&
                        random.find_first_not_of("0123456789abcdef", 1) == std::string_view::npos;
    return isOurs ? process : 0;
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), target_(path_) {
    const auto refuse = [&](int reason) { fail(ErrorKind::CannotCreate, path_, "cannot create the file", reason); };
    if (path_.empty()) refuse(ENOENT);
    if (path_.find('\0') != std::string::npos) refuse(EINVAL);
    struct stat status;
    if (::stat(path_.c_str(), &status) != 0) {
        if (errno != ENOENT) refuse(errno);
        if (path_.back() == '/') refuse(EISDIR);
    } else {
        if (S_ISDIR(status.st_mode)) refuse(EISDIR);
        if (::access(path_.c_str(), W_OK) != 0) refuse(errno);  // rename would pass over a file's own write protection
        inPlace_ = !S_ISREG(status.st_mode);
        std::error_code ignored;  // on failure the link itself is replaced
        if (const auto resolved = std::filesystem::canonical(path_, ignored); !inPlace_ && !resolved.empty())
            target_ = resolved.string();
    }
    if (inPlace_) return;
    openTemporary();
    if (::stat(target_.c_str(), &status) == 0) (void)!::fchmod(descriptor_, status.st_mode & 07777);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::openTemporary() {
    constexpr int kTries = 16;
    // The name itself must be possible, or the whole work of writing would end in a failed rename.
    const std::size_t longest = std::size_t(std::max(0L, ::pathconf(folderOf(target_).c_str(), _PC_NAME_MAX)));
    if (longest != 0 && target_.size() - (target_.rfind('/') + 1) > longest)
        fail(ErrorKind::CannotCreate, path_, "cannot create the file", ENAMETOOLONG);
    for (int i = 0; i < kTries && descriptor_ < 0; ++i) {
        temporary_ = temporaryName(target_);
        descriptor_ =
            uninterrupted([&] { return ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
        if (descriptor_ < 0 && errno != EEXIST) break;
    }
    if (descriptor_ >= 0) return;
    const int reason = errno;
    temporary_.clear();
    fail(ErrorKind::CannotCreate, path_, "cannot create the file", reason);
}

void AtomicFile::write(const void* data, std::size_t size) {
    const char* bytes = static_cast<const char*>(data);
    if (inPlace_) {
        if (memory_.size() < position_ + size) memory_.resize(position_ + size);
        memory_.replace(position_, size, bytes, size);
        position_ += size;
        return;
    }
    const std::size_t done = writeAll(bytes, size, [&](const char* from, std::size_t count, std::size_t offset) {
        return ::pwrite(descriptor_, from, count, off_t(position_ + offset));
    });
    if (done < size) failAt(position_ + done, path_);
    position_ += size;
}

void AtomicFile::commit() {
    inPlace_ ? commitInPlace() : commitByRename();
}

void AtomicFile::commitInPlace() {
    descriptor_ = uninterrupted([&] { return ::open(path_.c_str(), O_WRONLY | O_CLOEXEC); });
    if (descriptor_ < 0) fail(ErrorKind::CannotCreate, path_, "cannot open for writing", errno);
    const std::size_t done =
        writeAll(memory_.data(), memory_.size(),
                 [&](const char* from, std::size_t count, std::size_t) { return ::write(descriptor_, from, count); });
    if (done < memory_.size()) failAt(done, path_);
    const int result = ::close(std::exchange(descriptor_, -1));
    if (result != 0) fail(ErrorKind::CannotWrite, path_, "cannot close", errno);
}

void AtomicFile::commitByRename() {
    if (uninterrupted([&] { return ::fsync(descriptor_); }) != 0)
        fail(ErrorKind::CannotWrite, path_, "cannot sync to the disk", errno);
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(ErrorKind::CannotWrite, path_, "cannot close", errno);
    if (::rename(temporary_.c_str(), target_.c_str()) != 0)
        fail(ErrorKind::CannotCreate, path_, "cannot rename to it", errno);
    temporary_.clear();
    syncFolder(folderOf(target_), path_);
}

void removeAbandonedTemporaries(const std::string& path) {
    std::error_code ignored;
    const auto resolved = std::filesystem::canonical(path, ignored);
    const std::string target = resolved.empty() ? path : resolved.string(), prefix = temporaryPrefix(target);
    std::filesystem::directory_iterator entries(folderOf(target), ignored);
    for (; !ignored && entries != std::filesystem::directory_iterator(); entries.increment(ignored)) {
        const std::string name = entries->path().filename().string();
        if (!name.starts_with(prefix)) continue;
        const pid_t process = processIn(std::string_view(name).substr(prefix.size()));
        if (process > 0 && ::kill(process, 0) == -1 && errno == ESRCH) ::unlink(entries->path().c_str());
    }
}

void writeFileAtomically(const std::string& path, std::string_view bytes) {
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
}

}  // namespace penumbra
