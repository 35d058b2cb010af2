#include "core/base/unicode.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace penumbra {
namespace {

struct Decomposition {
    char32_t character, first, second;
};
struct CombiningRange {
    char32_t first, last;
    std::uint8_t combiningClass;
};

#include "core/base/data/unicode.inc"

// Hangul syllables are made by arithmetic (the Unicode Standard, section 3.12).
constexpr char32_t kSyllables = 0xAC00, kLeads = 0x1100, kVowels = 0x1161, kTrails = 0x11A7;
constexpr char32_t kLeadCount = 19, kVowelCount = 21, kTrailCount = 28;
constexpr char32_t kSyllableCount = kLeadCount * kVowelCount * kTrailCount;

std::uint8_t combiningClass(char32_t c) {
    const auto range = std::lower_bound(std::begin(kCombining), std::end(kCombining), c,
                                        [](const CombiningRange& r, char32_t x) { return r.last < x; });
    return range != std::end(kCombining) && range->first <= c ? range->combiningClass : 0;
}

template <std::size_t N>
const Decomposition* find(const Decomposition (&table)[N], char32_t c) {
    const auto row = std::lower_bound(std::begin(table), std::end(table), c,
                                      [](const Decomposition& d, char32_t x) { return d.character < x; });
    return row != std::end(table) && row->character == c ? row : nullptr;
}

/// Appends what c stands for when taken apart as far as it goes.
void decompose(char32_t c, std::u32string& out) {
    if (c >= kSyllables && c < kSyllables + kSyllableCount) {
        const char32_t s = c - kSyllables;
        out += kLeads + s / (kVowelCount * kTrailCount);
        out += kVowels + s % (kVowelCount * kTrailCount) / kTrailCount;
        if (s % kTrailCount != 0) out += kTrails + s % kTrailCount;
        return;
    }
    const Decomposition* d = find(kPrimary, c);
    if (!d) d = find(kOneWay, c);
    if (!d) {
        out += c;
        return;
    }
    decompose(d->first, out);
    if (d->second) decompose(d->second, out);
}

/// kPrimary in the order of its pairs.
const std::vector<Decomposition>& pairsInOrder() {
    static const std::vector<Decomposition> pairs = [] {
        std::vector<Decomposition> all(std::begin(kPrimary), std::end(kPrimary));
        std::sort(all.begin(), all.end(), [](const Decomposition& a, const Decomposition& b) {
            return std::pair(a.first, a.second) < std::pair(b.first, b.second);
        });
        return all;
    }();
    return pairs;
}

/// The one character that the two make; 0 where they make none.
char32_t compose(char32_t a, char32_t b) {
    if (a >= kLeads && a < kLeads + kLeadCount && b >= kVowels && b < kVowels + kVowelCount)
        return kSyllables + ((a - kLeads) * kVowelCount + (b - kVowels)) * kTrailCount;
    if (a >= kSyllables && a < kSyllables + kSyllableCount && (a - kSyllables) % kTrailCount == 0 && b > kTrails &&
        b < kTrails + kTrailCount)
        return a + (b - kTrails);
    const auto& pairs = pairsInOrder();
    const auto before = [](const Decomposition& d, const std::pair<char32_t, char32_t>& pair) {
        return std::pair(d.first, d.second) < pair;
    };
    const auto found = std::lower_bound(pairs.begin(), pairs.end(), std::pair(a, b), before);
    return found != pairs.end() && found->first == a && found->second == b ? found->character : 0;
}

std::u32string decoded(std::string_view utf8) {
    std::u32string out;
    for (std::size_t i = 0; i < utf8.size();) {
        const auto byte = static_cast<unsigned char>(utf8[i++]);
        const int more = byte < 0x80 ? 0 : byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
        char32_t c = more == 0 ? byte : byte & (0x3F >> more);
        for (int k = 0; k < more && i < utf8.size(); ++k)
            c = c << 6 | (static_cast<unsigned char>(utf8[i++]) & 0x3F);
        out += c;
    }
    return out;
}

std::string encoded(const std::u32string& text) {
    constexpr char32_t kFirstByte[] = {0, 0xC0, 0xE0, 0xF0};
    std::string out;
    for (const char32_t c : text) {
        const int more = c < 0x80 ? 0 : c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
        out += char(kFirstByte[more] | c >> 6 * more);
        for (int k = more - 1; k >= 0; --k)
            out += char(0x80 | (c >> 6 * k & 0x3F));
    }
    return out;
}

/// Marks that follow one letter in the order of their classes, equal classes as they stand.
void orderMarks(std::u32string& text) {
    for (auto begin = text.begin(); begin != text.end();) {
        const auto isLetter = [](char32_t c) { return combiningClass(c) == 0; };
        begin = std::find_if_not(begin, text.end(), isLetter);
        const auto end = std::find_if(begin, text.end(), isLetter);
        std::stable_sort(begin, end, [](char32_t a, char32_t b) { return combiningClass(a) < combiningClass(b); });
        begin = end;
    }
}

/// Joins each mark with the letter before it, unless one between them stands in its way.
void composeMarks(std::u32string& text) {
    constexpr std::size_t kNoLetter = std::u32string::npos;
    std::size_t letter = kNoLetter, kept = 0;
    int before = -1;  // class of what stands between the letter and the next mark; -1: nothing
    for (const char32_t c : std::u32string(text)) {
        const int own = combiningClass(c);
        const char32_t joined = letter != kNoLetter && before < own ? compose(text[letter], c) : 0;
        if (joined) {
            text[letter] = joined;
            continue;
        }
        if (own == 0) letter = kept;
        before = own == 0 ? -1 : own;
        text[kept++] = c;
    }
    text.resize(kept);
}

}  // namespace

std::string composed(std::string_view utf8) {
    // All up to U+02FF are as they should be; in UTF-8 their first bytes are below 0xCC.
    const auto isPlain = [](char c) { return static_cast<unsigned char>(c) < 0xCC; };
    if (std::all_of(utf8.begin(), utf8.end(), isPlain)) return std::string(utf8);
    std::u32string text;
    for (const char32_t c : decoded(utf8))
        decompose(c, text);
    orderMarks(text);
    composeMarks(text);
    return encoded(text);
}

}  // namespace penumbra
