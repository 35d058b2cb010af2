#include "scenes/pbrt/lexer.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <type_traits>

namespace penumbra::pbrt {

namespace {

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool endsWord(char c) {
    return isBlank(c) || c == '"' || c == '[' || c == ']' || c == '#';
}

enum class NumberFault { None, NotANumber, OutOfRange };

/// Where a number too small for its type and one too large look alike (std::from_chars), its power of ten tells them
/// apart. REQUIRES: a decimal number that from_chars has understood, without sign.
bool isBelowOne(const char* p, const char* end) {
    long beforePoint = 0, zerosAfterPoint = 0;
    bool point = false, nonzero = false;
    for (; p != end && (isDigit(*p) || *p == '.'); ++p) {
        if (*p == '.') {
            point = true;
        } else {
            nonzero = nonzero || *p != '0';
            if (nonzero && !point) ++beforePoint;
            if (!nonzero && point) ++zerosAfterPoint;
        }
    }
    long exponent = 0;
    if (p != end) {  // at the e
        const bool negative = *++p == '-';
        if (!isDigit(*p)) ++p;
        for (; p != end; ++p)
            exponent = std::min(10 * exponent + (*p - '0'), 1000000000L);
        if (negative) exponent = -exponent;
    }
    return beforePoint - zerosAfterPoint + exponent <= 0;
}

NumberFault scanHexadecimal(const char* p, const char* end, bool negative, double& value, const char*& after) {
    const std::from_chars_result result = std::from_chars(p, end, value, std::chars_format::hex);
    after = result.ptr;
    if (result.ec == std::errc::result_out_of_range) return NumberFault::OutOfRange;
    if (result.ec != std::errc() || (p != end && *p == '-')) return NumberFault::NotANumber;
    if (negative) value = -value;
    return NumberFault::None;
}

/// Reads a number that begins at p; `after` is behind it. Whether the word ends there is the caller's question.
template <class T>
NumberFault scanFloating(const char* p, const char* end, T& value, const char*& after) {
    const bool negative = p != end && *p == '-';
    if (p != end && (*p == '-' || *p == '+')) ++p;
    if (p == end || !(isDigit(*p) || *p == '.')) return NumberFault::NotANumber;  // from_chars would take "inf"
    if (*p == '0' && end - p > 2 && (p[1] == 'x' || p[1] == 'X')) {
        double wide = 0;
        const NumberFault fault = scanHexadecimal(p + 2, end, negative, wide, after);
        value = static_cast<T>(wide);
        return fault == NumberFault::None && value - value != 0 ? NumberFault::OutOfRange : fault;
    }
    const std::from_chars_result result = std::from_chars(p, end, value);
    after = result.ptr;
    if (result.ec == std::errc::invalid_argument) return NumberFault::NotANumber;
    if (result.ec == std::errc::result_out_of_range) {
        if (!isBelowOne(p, after)) return NumberFault::OutOfRange;
        value = 0;
    }
    if (negative) value = -value;
    return NumberFault::None;
}

NumberFault scanNumber(const char* p, const char* end, float& value, const char*& after) {
    return scanFloating(p, end, value, after);
}

NumberFault scanNumber(const char* p, const char* end, double& value, const char*& after) {
    return scanFloating(p, end, value, after);
}

NumberFault scanNumber(const char* p, const char* end, std::int32_t& value, const char*& after) {
    if (end - p > 1 && *p == '+' && isDigit(p[1])) ++p;
    const std::from_chars_result result = std::from_chars(p, end, value);
    after = result.ptr;
    if (result.ec == std::errc::invalid_argument) return NumberFault::NotANumber;
    return result.ec == std::errc() ? NumberFault::None : NumberFault::OutOfRange;
}

template <class T>
ErrorAt numberError(const Token& word, NumberFault fault) {
    if (fault == NumberFault::OutOfRange) {
        const char* range = std::is_same_v<T, std::int32_t> ? " does not fit a 32-bit integer"
                            : std::is_same_v<T, float>      ? " is out of range (at most 3.4e38)"
                                                            : " is out of range (at most 1.8e308)";
        return ErrorAt(word.where, "the number " + quote(word.text) + range);
    }
    const char* expected =
        std::is_same_v<T, std::int32_t> ? "expected an integer, found " : "expected a number, found ";
    return ErrorAt(word.where, expected + quote(word.text));
}

/// The place of the first byte that no UTF-8 text has there (overlong forms and surrogates included), if any.
std::optional<std::size_t> findInvalidUtf8(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const auto continues = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
    for (std::size_t i = 0; i < text.size();) {
        const unsigned first = byte(i);
        std::size_t length = 0;
        if (first < 0x80) length = 1;
        if (first >= 0xc2 && first < 0xe0) length = 2;
        if ((first & 0xf0) == 0xe0) length = 3;
        if (first >= 0xf0 && first < 0xf5) length = 4;
        bool valid = length > 0;
        for (std::size_t k = 1; k < length; ++k)
            valid = valid && continues(i + k);
        const unsigned second = byte(i + 1);
        if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) || (first == 0xf0 && second < 0x90) ||
            (first == 0xf4 && second >= 0x90) || !valid)
            return i;
        i += length;
    }
    return std::nullopt;
}

/// The character that `\c` stands for, if any.
std::optional<char> unescape(char c) {
    switch (c) {
        case 'b':
            return '\b';
        case 'f':
            return '\f';
        case 'n':
            return '\n';
        case 'r':
            return '\r';
        case 't':
            return '\t';
        case '\\':
        case '\'':
        case '"':
            return c;
        default:
            return std::nullopt;
    }
}

SourcePosition insideString(const Token& token, std::size_t offset) {
    SourcePosition where = token.where;
    where.column += 1 + static_cast<std::uint32_t>(offset);
    return where;
}

}  // namespace

std::string describe(const Token& token) {
    switch (token.kind) {
        case TokenKind::Word:
            return quote(token.text);
        case TokenKind::String:
            return "the string " + quote(token.text);
        case TokenKind::Open:
            return "'['";
        case TokenKind::Close:
            return "']'";
        case TokenKind::End:
            break;
    }
    return "the end of the file";
}

std::string decodeString(const Token& token) {
    if (const auto bad = findInvalidUtf8(token.text))
        throw ErrorAt(insideString(token, *bad), "the string is not valid UTF-8");
    std::string out;
    out.reserve(token.text.size());
    for (std::size_t i = 0; i < token.text.size(); ++i) {
        if (token.text[i] != '\\') {
            out += token.text[i];
            continue;
        }
        const std::optional<char> c = unescape(token.text[i + 1]);  // the lexer ends no string behind a backslash
        if (!c)
            throw ErrorAt(insideString(token, i), "unknown escape " + quote(token.text.substr(i, 2)) +
                                                      " in a string; known: \\b \\f \\n \\r \\t \\\\ \\' \\\"");
        out += *c;
        ++i;
    }
    return out;
}

template <class T>
T parseNumber(const Token& word) {
    const char* const begin = word.text.data();
    const char* const end = begin + word.text.size();
    T value{};
    const char* after = begin;
    NumberFault fault = scanNumber(begin, end, value, after);
    if (fault == NumberFault::None && after != end) fault = NumberFault::NotANumber;
    if (fault != NumberFault::None) throw numberError<T>(word, fault);
    return value;
}

template float parseNumber(const Token&);
template double parseNumber(const Token&);
template std::int32_t parseNumber(const Token&);

bool looksLikeNumber(std::string_view word) {
    if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.remove_prefix(1);
    if (!word.empty() && word[0] == '.') word.remove_prefix(1);
    return !word.empty() && isDigit(word[0]);
}

void checkEncoding(std::string_view text, std::uint32_t file) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
        throw ErrorAt({file, 1, 1}, "the text is UTF-16; a scene has to be UTF-8");
    const std::size_t nul = text.find('\0');
    if (nul == std::string_view::npos) return;
    SourcePosition where{file, 1, 1};
    for (std::size_t i = 0; i < nul; ++i) {
        const bool lineEnds = text[i] == '\n' || (text[i] == '\r' && text[i + 1] != '\n');
        where.line += lineEnds;
        where.column = lineEnds ? 1 : where.column + 1;
    }
    throw ErrorAt(where, "a NUL byte: this is no text in UTF-8");
}

Lexer::Lexer(std::string_view text, std::uint32_t file)
    : at_(text.data()), end_(text.data() + text.size()), lineStart_(at_), file_(file) {
    if (text.starts_with("\xef\xbb\xbf")) lineStart_ = at_ += 3;
}

void Lexer::skipBlanks() {
    for (; at_ != end_; ++at_) {
        switch (*at_) {
            case ' ':
            case '\t':
                break;
            case '#':
                while (at_ + 1 != end_ && at_[1] != '\n' && at_[1] != '\r')
                    ++at_;
                break;
            case '\r':
                if (at_ + 1 != end_ && at_[1] == '\n') break;
                [[fallthrough]];
            case '\n':
                ++line_;
                lineStart_ = at_ + 1;
                break;
            default:
                return;
        }
    }
}

Token Lexer::next() {
    skipBlanks();
    if (at_ == end_) return {TokenKind::End, {}, position()};
    if (*at_ == '"') return readString();
    if (*at_ != '[' && *at_ != ']') return readWord();
    const Token bracket{*at_ == '[' ? TokenKind::Open : TokenKind::Close, {at_, 1}, position()};
    ++at_;
    return bracket;
}

Token Lexer::readString() {
    const SourcePosition where = position();
    const char* const begin = at_ + 1;
    const char* p = begin;
    const auto endsLine = [this](const char* c) { return c == end_ || *c == '\n' || *c == '\r'; };
    while (!endsLine(p) && *p != '"')
        p += *p == '\\' && !endsLine(p + 1) ? 2 : 1;
    if (endsLine(p)) {
        const std::string_view text(begin, static_cast<std::size_t>(p - begin));
        throw ErrorAt(where, "the string " + quote(text) + " has no closing quote on its line");
    }
    at_ = p + 1;
    return {TokenKind::String, {begin, static_cast<std::size_t>(p - begin)}, where};
}

Token Lexer::readWord() {
    const SourcePosition where = position();
    const char* const begin = at_;
    at_ = std::find_if(at_, end_, endsWord);
    return {TokenKind::Word, {begin, static_cast<std::size_t>(at_ - begin)}, where};
}

template <class T>
void Lexer::appendNumbers(std::vector<T>& out) {
    for (;;) {
        skipBlanks();
        if (at_ == end_ || *at_ == '"' || *at_ == '[' || *at_ == ']') return;
        T value{};
        const char* after = at_;
        NumberFault fault = scanNumber(at_, end_, value, after);
        if (fault == NumberFault::None && after != end_ && !endsWord(*after)) fault = NumberFault::NotANumber;
        if (fault != NumberFault::None) throw numberError<T>(readWord(), fault);
        out.push_back(value);
        at_ = after;
    }
}

template void Lexer::appendNumbers(std::vector<float>&);
template void Lexer::appendNumbers(std::vector<std::int32_t>&);

}  // namespace penumbra::pbrt
