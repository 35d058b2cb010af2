// Sources: the token stream of a scene over all its text files.
//
// include() puts a file's tokens at this point of the stream, so a directive may begin in one file and go on in the
// file that includes it. A nested part (Import) is a stretch of the stream that ends by itself: from beginPart() to
// endPart() the stream yields End where the imported file ends. Files are resolved by resolvePath(), opened by
// ByteReader (plain or gzip), held whole while they are read.
//
// Invariants: every file opened is in SceneDescription::files, once. Tokens are views into their file: decode a token
// before asking for the next one. Hostile input: files nest at most kDeepest deep; a file inside itself is an error; at
// most kMostFiles are opened; text that is read several times may be at most kRepeatedAllowed bytes plus kRepeats times
// all files' size, so that doubling includes end soon. Errors: ErrorAt (lexical errors, files that cannot be read: at
// the place of their name). Thread safety: none; one instance belongs to one thread.
#pragma once

#include "scenes/description.h"
#include "scenes/pbrt/lexer.h"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

namespace penumbra::pbrt {

class Sources {
public:
    static constexpr std::size_t kDeepest = 64;
    static constexpr std::size_t kMostFiles = 100000;
    static constexpr std::uint64_t kRepeatedAllowed = std::uint64_t{256} << 20;
    static constexpr std::uint64_t kRepeats = 16;

    /// `scene` must outlive this object; its topFile says where relative names begin.
    explicit Sources(SceneDescription& scene) : scene_(scene) {}

    /// The top of the scene: a file, standard input, or a text that outlives this object.
    void openTopFile(const std::string& path);
    void openStandardInput();
    void openText(std::string_view text, const std::string& name);

    /// `where` is the place of the file's name in the scene.
    void include(const std::string& name, SourcePosition where);
    /// As include(), but the stream ends where that file does, until endPart(). Returns what endPart() needs. Parts
    /// nest.
    std::size_t beginPart(const std::string& name, SourcePosition where);
    void endPart(std::size_t outerFloor);

    const Token& peek();
    Token next();
    /// The next tokens as numbers, as far as they are; see Lexer::appendNumbers. REQUIRES: no token has been peeked at.
    template <class T>
    void appendNumbers(std::vector<T>& out) {
        open_.back()->lexer.appendNumbers(out);
    }

    /// ", included from a.pbrt:3:9, included from ..." for the file being read; empty for the top file.
    std::string includeChain() const;

private:
    using Identity = std::pair<std::uint64_t, std::uint64_t>;  // device and inode: the same file under any name

    struct FileStatus {
        Identity identity;
        std::uint64_t size = 0;
    };

    struct Source {
        Source(std::string owned, std::string_view borrowed, std::uint32_t file)
            : text(std::move(owned)), lexer(borrowed.empty() ? std::string_view(text) : borrowed, file) {}
        std::string text;
        Lexer lexer;
        SourcePosition includedAt;
        std::optional<Identity> identity;
    };

    template <class Work>
    static void atPlace(SourcePosition where, const Work& work);
    static FileStatus statusOf(const std::string& path, SourcePosition where);
    std::uint32_t fileIndex(const std::string& name);
    void noteDigest(std::uint32_t file, std::string_view text);
    void push(const std::string& path, const FileStatus& status, SourcePosition where);
    void checkNesting(const Identity& identity, const std::string& name, SourcePosition where) const;
    void chargeText(const Identity& identity, std::uint64_t bytes, SourcePosition where);

    SceneDescription& scene_;
    std::vector<std::unique_ptr<Source>> open_;  ///< the innermost last
    std::size_t floor_ = 1;                      ///< open files from which on End ends the part being read
    std::optional<Token> peeked_;
    std::map<std::string, std::uint32_t> fileIndices_;
    std::set<Identity> seen_;
    std::size_t filesOpened_ = 0;
    std::uint64_t distinctBytes_ = 0, repeatedBytes_ = 0;
};

}  // namespace penumbra::pbrt
