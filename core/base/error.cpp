#include "core/base/error.h"

#include "core/base/text.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace penumbra {

namespace {

constexpr std::size_t kMostKnown = 50;         // names that a suggestion lists
constexpr std::size_t kLongestCompared = 100;  // longer names are never near anything: bounds the cost of hostile ones

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte != 0x7f) {
            out += c;
            continue;
        }
        char code[5];
        std::snprintf(code, sizeof code, "\\x%02x", byte);
        out += code;
    }
    return out;
}

/// Optimal string alignment distance (Levenshtein with swaps of neighbours), by rows.
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t(0));
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = a[i - 1] == b[j - 1];
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before.swap(last);
        last.swap(row);
    }
    return last[b.size()];
}

}  // namespace

std::string quote(std::string_view text, std::size_t most) {
    std::size_t cut = std::min(most, text.size());
    while (cut > 0 && cut < text.size() && (static_cast<unsigned char>(text[cut]) & 0xc0) == 0x80)
        --cut;  // whole characters
    std::string out = "'";
    out += escaped(text.substr(0, cut));
    out += cut < text.size() ? "...'" : "'";
    return out;
}

std::string formatPosition(std::span<const std::string> files, SourcePosition where) {
    std::string text = where.file < files.size() ? escaped(files[where.file]) : "(unknown file)";
    if (where.line == 0) return text;
    return text.append(":").append(std::to_string(where.line)).append(":").append(std::to_string(where.column));
}

Error ErrorAt::placed(std::span<const std::string> files) const {
    return Error(kind(), formatPosition(files, where_) + ": " + what());
}

std::vector<std::string> nearestNames(std::string_view name, std::span<const std::string> known, std::size_t most) {
    struct Candidate {
        std::size_t distance, index;
    };
    std::vector<Candidate> near;
    for (std::size_t i = 0; i < known.size() && name.size() <= kLongestCompared; ++i) {
        const std::string& other = known[i];
        const std::size_t longer = std::max(name.size(), other.size());
        const std::size_t allowed = longer / 3;
        if (longer - std::min(name.size(), other.size()) > allowed || other.size() > kLongestCompared) continue;
        const std::size_t distance = editDistance(lowerCase(name), lowerCase(other));
        if (distance <= allowed) near.push_back({distance, i});
    }
    std::stable_sort(near.begin(), near.end(), [](Candidate a, Candidate b) { return a.distance < b.distance; });
    std::vector<std::string> names;
    for (const Candidate& c : near) {
        if (names.size() >= most) break;
        if (std::find(names.begin(), names.end(), known[c.index]) == names.end()) names.push_back(known[c.index]);
    }
    return names;
}

std::string suggestion(std::string_view name, std::span<const std::string> known) {
    if (known.empty()) return "";
    const std::vector<std::string> near = nearestNames(name, known);
    std::string text;
    for (const std::string& n : near)
        text += (text.empty() ? "; did you mean " : " or ") + quote(n);
    if (!near.empty()) return text + "?";
    text = "; known: ";
    for (std::size_t i = 0; i < std::min(known.size(), kMostKnown); ++i)
        text += (i == 0 ? "" : ", ") + escaped(known[i]);
    return text + (known.size() > kMostKnown ? ", ..." : "");
}

}  // namespace penumbra
