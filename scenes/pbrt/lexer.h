// Lexer: the tokens of one text in the pbrt format, with their places.
//
// Conventions: blanks are space, tab, LF, CR; `#` starts a comment; CR LF, LF and CR each end a line. Lines and columns
// count from 1, columns in bytes (a byte order mark at the beginning counts for nothing). A bare word ends at a blank,
// `"`, `[`,
// `]` or `#`. A string may not hold a raw line end.
// Numbers: decimal or hexadecimal (0x), an optional sign, independent of the locale; "inf" and "nan" are not numbers; a
// number too small for its type is zero, one too large an error.
//
// Invariants: tokens are views into the text, which must outlive them. Nothing is allocated but by decodeString and
// errors. Errors: ErrorAt with the place of the token (of the very byte, inside strings).
#pragma once

#include "core/base/error.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::pbrt {

enum class TokenKind : std::uint8_t { Word, String, Open, Close, End };

struct Token {
    TokenKind kind = TokenKind::End;
    std::string_view text;  ///< a string's lies between the quotes, escapes still in it
    SourcePosition where;   ///< of the first character, a string's quote included
};

/// The token as a message names it: 'word', the string 'text', '[', ']', the end of the file.
std::string describe(const Token& token);

/// The text that a string token stands for: escapes undone. Throws at an unknown escape and at what is not UTF-8.
std::string decodeString(const Token& token);

/// The number that a word stands for; throws where it is none. T is float, double or std::int32_t.
template <class T>
T parseNumber(const Token& word);

/// True where the word begins as a number does.
bool looksLikeNumber(std::string_view word);

/// Throws where the text is not one that a scene can be written in: it holds a NUL byte, or is UTF-16.
void checkEncoding(std::string_view text, std::uint32_t file);

class Lexer {
public:
    Lexer(std::string_view text, std::uint32_t file);

    /// The next token; End for ever at the end.
    Token next();

    /// Appends the numbers from here to the first token that is no word; throws at a word that is no number. This is
    /// the path of large meshes.
    template <class T>
    void appendNumbers(std::vector<T>& out);

private:
    void skipBlanks();
    SourcePosition position() const { return {file_, line_, static_cast<std::uint32_t>(at_ - lineStart_) + 1}; }
    Token readString();
    Token readWord();

    const char* at_;
    const char* end_;
    const char* lineStart_;
    std::uint32_t line_ = 1;
    std::uint32_t file_;
};

}  // namespace penumbra::pbrt
