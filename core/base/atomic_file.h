// AtomicFile: a file that appears whole or not at all, even if the power fails.
//
// Bytes go to a hidden temporary file in the same folder (".name.tmp.host.pid.random"); commit() syncs it, renames it
// over the path and syncs the folder. Until then an older file of that name is untouched; without commit() the
// temporary file is removed. A symbolic link is followed, so the file that it points to is replaced. A path that is no
// regular file (a device, a pipe) cannot be renamed over: its bytes are kept in memory and written by commit().
//
// Errors: Error(CannotCreate) where the file cannot be made, Error(CannotWrite) where bytes cannot be written; both
// name the path and the system's reason.
//
// Thread safety: none; one instance belongs to one thread. Two processes that write one path at once leave one whole
// file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace penumbra {

class AtomicFile {
public:
    explicit AtomicFile(std::string path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Writes at the position and moves it behind.
    void write(const void* data, std::size_t size);
    void write(std::string_view bytes) { write(bytes.data(), bytes.size()); }
    /// Later writes go there; writing behind the end leaves zeros between.
    void seek(std::uint64_t position) { position_ = position; }
    std::uint64_t position() const { return position_; }

    /// Makes the file appear. Nothing may be written afterwards.
    void commit();

private:
    void openTemporary();
    void commitInPlace();
    void commitByRename();

    std::string path_;       ///< as given, for messages
    std::string target_;     ///< what is replaced: links resolved
    std::string temporary_;  ///< empty: none exists (any more)
    std::string memory_;     ///< the bytes for a path that is no regular file
    std::uint64_t position_ = 0;
    int descriptor_ = -1;  ///< of the temporary file
    bool inPlace_ = false;
};

/// Removes what killed processes of this machine left beside the path: their temporary files. What cannot be removed
/// stays.
void removeAbandonedTemporaries(const std::string& path);

/// The whole file at once.
void writeFileAtomically(const std::string& path, std::string_view bytes);

}  // namespace penumbra
