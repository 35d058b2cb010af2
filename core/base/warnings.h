// Warnings of cold code: collected, said once each, and errors under --strict.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace penumbra {

/// Collects the warnings of reading and building a scene. Equal texts are kept once, and at most kMost of them: a last
/// text then says that more were left out. Thread safety: none; one instance belongs to one thread.
class Warnings {
public:
    static constexpr std::size_t kMost = 1000;

    explicit Warnings(bool strict = false) : strict_(strict) {}
    /// Keeps the text; throws Error(BadData) instead where strict.
    void add(const std::string& text);
    const std::vector<std::string>& all() const { return texts_; }
    bool strict() const { return strict_; }

private:
    bool strict_;
    std::set<std::string> seen_;
    std::vector<std::string> texts_;
};

}  // namespace penumbra
