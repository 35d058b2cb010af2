// Tokens, numbers, strings and places of the pbrt text format.
#include "scenes/pbrt/lexer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace penumbra::pbrt {
namespace {

std::string placeOf(SourcePosition where) {
    return std::to_string(where.line) + ":" + std::to_string(where.column);
}

/// All tokens as "kind(text)@line:column", blanks between.
std::string tokensOf(std::string_view text) {
    Lexer lexer(text, 0);
    std::string out;
    for (;;) {
        const Token token = lexer.next();
        const char kind = "wso]."[static_cast<int>(token.kind)];
        out += (out.empty() ? "" : " ") + std::string(1, kind) + "(" + std::string(token.text) + ")@" +
               placeOf(token.where);
        if (token.kind == TokenKind::End) return out;
    }
}

/// "line:column message" of the error that `action` throws.
std::string errorOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const ErrorAt& e) {
        return placeOf(e.where()) + " " + e.what();
    }
    return "no error";
}

Token firstToken(std::string_view text) {
    return Lexer(text, 0).next();
}

TEST(ScenesPbrtLexer, Tokens) {
    struct Case {
        std::string_view text;
        std::string expected;
    };
    const std::vector<Case> cases{
        {"", ".()@1:1"},
        {"Shape \"sphere\"", "w(Shape)@1:1 s(sphere)@1:7 .()@1:15"},
        {"\"float x\"[1]", "s(float x)@1:1 o([)@1:10 w(1)@1:11 ](])@1:12 .()@1:13"},
        {"a\tb\n c", "w(a)@1:1 w(b)@1:3 w(c)@2:2 .()@2:3"},
        {"a\r\nb\rc\n\rd", "w(a)@1:1 w(b)@2:1 w(c)@3:1 w(d)@5:1 .()@5:2"},
        {"# all\n#\na # \"no [ string\nb#c\n", "w(a)@3:1 w(b)@4:1 .()@5:1"},
        {"# mac\rb", "w(b)@2:1 .()@2:2"},
        {"#", ".()@1:2"},
        {"\"#not | a :: comment\"", "s(#not | a :: comment)@1:1 .()@1:22"},
        {R"("a\"b" c)", R"(s(a\"b)@1:1 w(c)@1:8 .()@1:9)"},
        {"\xef\xbb\xbf"
         "a",
         "w(a)@1:1 .()@1:2"},
        {"a\"b\"c", "w(a)@1:1 s(b)@1:2 w(c)@1:5 .()@1:6"},
    };
    for (const Case& c : cases)
        EXPECT_EQ(tokensOf(c.text), c.expected) << c.text;
}

TEST(ScenesPbrtLexer, Strings) {
    EXPECT_EQ(decodeString(firstToken(R"("plain")")), "plain");
    EXPECT_EQ(decodeString(firstToken(R"("\b\f\n\r\t\\\'\"")")), "\b\f\n\r\t\\'\"");
    EXPECT_EQ(decodeString(firstToken("\"\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80\"")),
              "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80");
    struct Case {
        std::string_view text;
        std::string expected;
    };
    const std::vector<Case> cases{
        {"  \"open", "1:3 the string 'open' has no closing quote on its line"},
        {"\"open\nclosed\"", "1:1 the string 'open' has no closing quote on its line"},
        {"\"open\\\nclosed\"", "1:1 the string 'open\\' has no closing quote on its line"},
        {"\"open\\", "1:1 the string 'open\\' has no closing quote on its line"},
        {R"("C:\dir")", R"(1:4 unknown escape '\d' in a string; known: \b \f \n \r \t \\ \' \")"},
        {"\"ab\xff\"", "1:4 the string is not valid UTF-8"},
        {"\"\xc3\"", "1:2 the string is not valid UTF-8"},
        {"\"\xc0\xaf\"", "1:2 the string is not valid UTF-8"},          // overlong
        {"\"\xed\xa0\x80\"", "1:2 the string is not valid UTF-8"},      // a surrogate
        {"\"\xf4\x90\x80\x80\"", "1:2 the string is not valid UTF-8"},  // beyond U+10FFFF
    };
    for (const Case& c : cases)
        EXPECT_EQ(errorOf([&] { decodeString(firstToken(c.text)); }), c.expected) << c.text;
}

TEST(ScenesPbrtLexer, Numbers) {
    struct Case {
        std::string_view text;
        double expected;
    };
    const std::vector<Case> cases{{"0", 0},     {"-0.5", -0.5}, {"+3", 3},      {".25", 0.25},
                                  {"5.", 5},    {"1e3", 1000},  {"1E-2", 0.01}, {"-1e+2", -100},
                                  {"0x1F", 31}, {"-0x10", -16}, {"1e-400", 0},  {"-1e-9999999999", 0},
                                  {"0.1", 0.1}, {"00012", 12},  {"0x1.8p1", 3}, {"1e-46", 1e-46}};
    for (const Case& c : cases) {
        EXPECT_EQ(parseNumber<double>(firstToken(c.text)), c.expected) << c.text;
        EXPECT_EQ(parseNumber<float>(firstToken(c.text)), static_cast<float>(c.expected)) << c.text;
    }
    EXPECT_TRUE(std::signbit(parseNumber<float>(firstToken("-0"))));
    EXPECT_EQ(parseNumber<float>(firstToken("3.4028235e38")), std::numeric_limits<float>::max());
    EXPECT_EQ(parseNumber<float>(firstToken("1e-45")), std::numeric_limits<float>::denorm_min());
    EXPECT_EQ(parseNumber<float>(firstToken("0." + std::string(1000, '0') + "1")), 0.f);
    EXPECT_EQ(parseNumber<float>(firstToken("1" + std::string(1000, '0') + "e-1000")), 1.f);
    EXPECT_EQ(parseNumber<std::int32_t>(firstToken("-2147483648")), std::numeric_limits<std::int32_t>::min());
    EXPECT_EQ(parseNumber<std::int32_t>(firstToken("+12")), 12);
}

TEST(ScenesPbrtLexer, NotNumbers) {
    for (const std::string_view text :
         {"nan", "inf", "-inf", "-nan(0x1)", "infinity", "1,5", "1.2.3", "1e",   "e5",    "+-1", "--1",
          "-",   "+",   ".",    "1f",        "0x",       "0xg", "0x-1",  "true", "1e5e5", "-+1"}) {
        EXPECT_EQ(errorOf([&] { parseNumber<float>(firstToken(text)); }),
                  "1:1 expected a number, found " + quote(text));
    }
    for (const std::string_view text : {"1e400", "-1e39", "1e99999999999999999999", "0x1p999", "3.5e38"})
        EXPECT_EQ(errorOf([&] { parseNumber<float>(firstToken(text)); }),
                  "1:1 the number " + quote(text) + " is out of range (at most 3.4e38)");
    for (const std::string_view text : {"1.0", "1e3", "0x10", "a", "1.", "+-1", "+"})
        EXPECT_EQ(errorOf([&] { parseNumber<std::int32_t>(firstToken(text)); }),
                  "1:1 expected an integer, found " + quote(text));
    for (const std::string_view text : {"2147483648", "9223372036854775808", "-2147483649"})
        EXPECT_EQ(errorOf([&] { parseNumber<std::int32_t>(firstToken(text)); }),
                  "1:1 the number " + quote(text) + " does not fit a 32-bit integer");
}

TEST(ScenesPbrtLexer, NumbersInARowStopAtWhatIsNoWord) {
    Lexer lexer("1 2.5 # three\n -3]4", 0);
    std::vector<float> numbers;
    lexer.appendNumbers(numbers);
    EXPECT_EQ(numbers, (std::vector<float>{1, 2.5f, -3}));
    EXPECT_EQ(lexer.next().kind, TokenKind::Close);
    lexer.appendNumbers(numbers);
    EXPECT_EQ(numbers.back(), 4.f);
    EXPECT_EQ(lexer.next().kind, TokenKind::End);
    Lexer words("1\n2 Shape", 0);
    EXPECT_EQ(errorOf([&] { words.appendNumbers(numbers); }), "2:3 expected a number, found 'Shape'");
    Lexer fraction("1 2.5", 0);
    std::vector<std::int32_t> integers;
    EXPECT_EQ(errorOf([&] { fraction.appendNumbers(integers); }), "1:3 expected an integer, found '2.5'");
}

TEST(ScenesPbrtLexer, Encodings) {
    using namespace std::string_view_literals;
    EXPECT_EQ(errorOf([] { checkEncoding("\xff\xfeW\0"sv, 0); }), "1:1 the text is UTF-16; a scene has to be UTF-8");
    EXPECT_EQ(errorOf([] { checkEncoding("\xfe\xff\0W"sv, 0); }), "1:1 the text is UTF-16; a scene has to be UTF-8");
    EXPECT_EQ(errorOf([] { checkEncoding("a\r\nb\rcd\0"sv, 0); }), "3:3 a NUL byte: this is no text in UTF-8");
    EXPECT_EQ(errorOf([] { checkEncoding("", 0); }), "no error");
}

}  // namespace
}  // namespace penumbra::pbrt
