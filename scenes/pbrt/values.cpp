#include "scenes/pbrt/values.h"

#include "core/base/unicode.h"

#include <algorithm>
#include <array>
#include <utility>

namespace penumbra::pbrt {

namespace {

enum class ValueKind { Numbers, Integers, Booleans, Strings, NumbersOrStrings };

struct TypeRule {
    std::string_view type;
    ValueKind kind;
    std::size_t multiple;  ///< the values come in groups of so many
};

constexpr std::array<TypeRule, 13> kTypeRules{{
    {"float", ValueKind::Numbers, 1},
    {"integer", ValueKind::Integers, 1},
    {"bool", ValueKind::Booleans, 1},
    {"string", ValueKind::Strings, 1},
    {"point2", ValueKind::Numbers, 2},
    {"vector2", ValueKind::Numbers, 2},
    {"point3", ValueKind::Numbers, 3},
    {"vector3", ValueKind::Numbers, 3},
    {"normal", ValueKind::Numbers, 3},
    {"rgb", ValueKind::Numbers, 3},
    {"blackbody", ValueKind::Numbers, 1},
    {"spectrum", ValueKind::NumbersOrStrings, 2},
    {"texture", ValueKind::Strings, 1},
}};

/// The words that pbrt-v3 used.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kOldTypes{
    {{"point", "point3"}, {"vector", "vector3"}, {"color", "rgb"}, {"normal3", "normal"}}};

const TypeRule* findRule(std::string_view type) {
    const auto rule =
        std::find_if(kTypeRules.begin(), kTypeRules.end(), [&](const TypeRule& r) { return r.type == type; });
    return rule == kTypeRules.end() ? nullptr : &*rule;
}

/// The words of a text, parted by blanks.
std::vector<std::string> splitWords(std::string_view text) {
    constexpr std::string_view blanks = " \t\n\r";
    std::vector<std::string> words;
    for (std::size_t begin = text.find_first_not_of(blanks); begin != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
        words.emplace_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(blanks, end);
    }
    return words;
}

std::uint8_t parseBoolean(const Token& token) {
    const bool isText = token.kind == TokenKind::Word || token.kind == TokenKind::String;
    if (isText && token.text == "true") return 1;
    if (isText && token.text == "false") return 0;
    throw ErrorAt(token.where, "expected true or false, found " + describe(token));
}

std::string parseString(const Token& token) {
    if (token.kind != TokenKind::String)
        throw ErrorAt(token.where, "expected a string in quotes, found " + describe(token));
    return decodeString(token);
}

std::string declared(const Parameter& p) {
    return quote(p.type + " " + p.name);
}

}  // namespace

std::string ValueReader::readString(std::string_view what) {
    const Token token = sources_.next();
    if (token.kind != TokenKind::String)
        throw ErrorAt(token.where, "expected " + std::string(what) + " in quotes, found " + describe(token));
    return decodeString(token);
}

std::string ValueReader::readName(std::string_view what) {
    return composed(readString(what));
}

void ValueReader::readNumbers(std::string_view directive, std::span<double> out) {
    const Token first = sources_.peek();
    const bool bracketed = first.kind == TokenKind::Open;
    if (bracketed) sources_.next();
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Token token = sources_.next();
        if (token.kind != TokenKind::Word || !looksLikeNumber(token.text))
            throw ErrorAt(token.where, quote(directive) + " needs " + std::to_string(out.size()) +
                                           " numbers, but after " + std::to_string(i) + " comes " + describe(token));
        out[i] = parseNumber<double>(token);
    }
    if (!bracketed) return;
    const Token close = sources_.next();
    if (close.kind != TokenKind::Close)
        throw ErrorAt(close.where, "expected ']' after the " + std::to_string(out.size()) + " numbers of '" +
                                       std::string(directive) + "', found " + describe(close));
}

ParameterSet ValueReader::readParameters(const std::string& colorSpace) {
    ParameterSet set;
    while (stringFollows()) {
        Parameter p = readDeclaration();
        if (set.all().size() >= kMostParameters)
            throw ErrorAt(p.where, "more than " + std::to_string(kMostParameters) + " parameters in one directive");
        readValue(p);
        if (p.type == "rgb") p.colorSpace = colorSpace;
        addOrReplace(set, std::move(p));
    }
    return set;
}

Parameter ValueReader::readDeclaration() {
    const Token token = sources_.next();
    std::vector<std::string> words = splitWords(decodeString(token));
    if (words.size() != 2)
        throw ErrorAt(token.where, "expected a parameter as \"type name\", found " + describe(token));
    Parameter p;
    p.where = token.where;
    p.type = std::move(words[0]);
    p.name = std::move(words[1]);
    const auto old = std::find_if(kOldTypes.begin(), kOldTypes.end(), [&](const auto& o) { return o.first == p.type; });
    if (old != kOldTypes.end()) p.type = old->second;
    if (!findRule(p.type))
        throw ErrorAt(token.where, "unknown type " + quote(p.type) + " of parameter " + quote(p.name) +
                                       suggestion(p.type, parameterTypes()));
    return p;
}

void ValueReader::addOrReplace(ParameterSet& set, Parameter p) {
    std::vector<Parameter>& list = set.all();
    const auto twin =
        std::find_if(list.begin(), list.end(), [&](const Parameter& other) { return other.name == p.name; });
    if (twin != list.end()) {
        warnings_.add(scene_.position(p.where) + ": parameter " + declared(p) + " replaces " + declared(*twin) +
                      " of the same directive");
        list.erase(twin);
    }
    set.add(std::move(p));
}

template <class Visit>
void ValueReader::visitValue(Visit&& visit) {
    const Token first = sources_.next();
    if (first.kind != TokenKind::Open) return visit(first);
    for (;;) {
        const Token token = sources_.next();
        if (token.kind == TokenKind::Close) return;
        if (token.kind != TokenKind::Word && token.kind != TokenKind::String) failInList(first, token);
        visit(token);
    }
}

template <class T>
std::vector<T> ValueReader::readNumberList() {
    const Token first = sources_.next();
    if (first.kind == TokenKind::Word) return {parseNumber<T>(first)};
    if (first.kind != TokenKind::Open) throw ErrorAt(first.where, "expected a number or '[', found " + describe(first));
    std::vector<T> list;
    for (;;) {
        try {
            sources_.appendNumbers(list);
        } catch (const ErrorAt& e) {
            throw ErrorAt(e.where(), e.what() + inListFrom(first));
        }
        const Token token = sources_.next();
        if (token.kind == TokenKind::Close) return list;
        if (token.kind != TokenKind::Word) failInList(first, token);
        list.push_back(parseNumber<T>(token));  // an included file has ended inside the list
    }
}

void ValueReader::readSpectrum(Parameter& p) {
    std::vector<float> numbers;
    std::vector<std::string> names;
    visitValue([&](const Token& token) {
        if (token.kind == TokenKind::Word)
            numbers.push_back(parseNumber<float>(token));
        else
            names.push_back(parseString(token));
        if (!numbers.empty() && !names.empty())
            throw ErrorAt(token.where, "a spectrum is either numbers or a name, not both");
    });
    if (names.empty())
        p.values = std::move(numbers);
    else
        p.values = std::move(names);
}

void ValueReader::readValue(Parameter& p) {
    switch (findRule(p.type)->kind) {
        case ValueKind::Numbers:
            p.values = readNumberList<float>();
            break;
        case ValueKind::Integers:
            p.values = readNumberList<std::int32_t>();
            break;
        case ValueKind::Booleans: {
            std::vector<std::uint8_t> list;
            visitValue([&](const Token& token) { list.push_back(parseBoolean(token)); });
            p.values = std::move(list);
            break;
        }
        case ValueKind::Strings: {
            std::vector<std::string> list;
            const bool isName = p.type == "texture";
            visitValue([&](const Token& token) {
                list.push_back(isName ? composed(parseString(token)) : parseString(token));
            });
            p.values = std::move(list);
            break;
        }
        case ValueKind::NumbersOrStrings:
            readSpectrum(p);
            break;
    }
    checkValue(p);
}

void ValueReader::skipValue() {
    visitValue([](const Token&) {});
}

void ValueReader::skipValues() {
    for (;;) {
        const Token& token = sources_.peek();
        const bool isWord = token.kind == TokenKind::Word;
        const bool isValue = token.kind == TokenKind::String || token.kind == TokenKind::Open ||
                             (isWord && (looksLikeNumber(token.text) || token.text == "true" || token.text == "false"));
        if (!isValue) return;
        skipValue();
    }
}

void ValueReader::checkValue(const Parameter& p) {
    const std::size_t count = p.count();
    const std::size_t multiple = p.isText() ? 1 : findRule(p.type)->multiple;
    if (count == 0) throw ErrorAt(p.where, "parameter " + declared(p) + " has no value");
    if (count % multiple != 0)
        throw ErrorAt(p.where, "parameter " + declared(p) + " needs numbers in groups of " + std::to_string(multiple) +
                                   ", but has " + std::to_string(count));
    if (p.type == "texture" && count != 1)
        throw ErrorAt(p.where,
                      "parameter " + declared(p) + " needs the name of one texture, but has " + std::to_string(count));
    if (p.type != "rgb") return;
    const auto negative = std::find_if(p.floats().begin(), p.floats().end(), [](float value) { return value < 0; });
    if (negative != p.floats().end())
        throw ErrorAt(p.where, "parameter " + declared(p) + " has the negative value " + std::to_string(*negative));
}

std::string ValueReader::inListFrom(const Token& open) const {
    return ", in the list that begins at " + scene_.position(open.where);
}

void ValueReader::failInList(const Token& open, const Token& found) const {
    if (found.kind == TokenKind::End) throw ErrorAt(open.where, "the list has no closing ']'");
    throw ErrorAt(found.where, "expected a value or ']', found " + describe(found) + inListFrom(open));
}

}  // namespace penumbra::pbrt
