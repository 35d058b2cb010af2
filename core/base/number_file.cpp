#include "core/base/number_file.h"

#include "core/base/byte_reader.h"
#include "core/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace penumbra {
namespace {

/// A word of the file and its place, both from 1.
struct Word {
    std::string_view text;
    int line = 0, column = 0;
};

/// Splits text into words between white space and commas, without # comments.
std::vector<Word> splitWords(std::string_view text) {
    constexpr std::string_view kBetween = " \t\r\n,";
    std::vector<Word> words;
    int line = 1;
    std::size_t lineStart = 0;
    for (std::size_t i = 0; i < text.size();) {
        if (text[i] == '\n') {
            ++line;
            lineStart = ++i;
        } else if (text[i] == '#') {
            i = std::min(text.find('\n', i), text.size());
        } else if (kBetween.find(text[i]) != std::string_view::npos) {
            ++i;
        } else {
            const std::size_t end = std::min(text.find_first_of(" \t\r\n,#", i), text.size());
            words.push_back({text.substr(i, end - i), line, int(i - lineStart) + 1});
            i = end;
        }
    }
    return words;
}

std::string readText(const std::string& path, std::string_view what) {
    constexpr std::size_t kLargest = std::size_t(8) << 20;  // a 1 nm table has some 10 KB
    ByteReader reader = ByteReader::open(path);
    std::string text;
    while (reader.fill(1)) {
        text.append(reader.data(), reader.available());
        reader.consume(reader.available());
        if (text.size() > kLargest)
            throw Error(ErrorKind::BadData,
                        fmt::format("{}: too large for a {} (over {} MiB)", pathText(path), what, kLargest >> 20));
    }
    return text;
}

float numberOf(const Word& word, const std::string& path) {
    std::string_view text = word.text;
    if (text.starts_with('+')) text.remove_prefix(1);
    float value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw Error(ErrorKind::BadData, fmt::format("{}:{}:{}: expected a finite number, found {}", pathText(path),
                                                    word.line, word.column, quote(word.text)));
    return value;
}

}  // namespace

std::vector<float> readNumbers(const std::string& path, std::string_view what) {
    const std::string text = readText(path, what);
    std::vector<float> numbers;
    for (const Word& word : splitWords(text))
        numbers.push_back(numberOf(word, path));
    return numbers;
}

}  // namespace penumbra
