// The directives that change the attribute state: transforms, defaults, colour space; and those that read other files.
#include "core/base/text.h"
#include "scenes/pbrt/parser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace penumbra::pbrt {

namespace {

/// A single-precision transform has to be made of these later.
bool fitsFloat(double value) {
    return std::abs(value) < 1e38;
}

}  // namespace

void Parser::identity() {
    if (state().startActive) state().ctm.start = Matrix4{};
    if (state().endActive) state().ctm.end = Matrix4{};
}

/// CTM <- CTM M for the active times. Equal matrices stay equal: both products are made by the same operations.
void Parser::multiply(const Matrix4& m) {
    Matrix4 inverse;
    if (!invert(m, inverse)) throw ErrorAt(where_, "the matrix of " + quote(directive_) + " has no inverse");
    TransformPair& ctm = state().ctm;
    if (state().startActive) ctm.start = ctm.start * m;
    if (state().endActive) ctm.end = ctm.end * m;
    checkFinite(ctm.start);
    checkFinite(ctm.end);
}

void Parser::checkFinite(const Matrix4& m) const {
    for (const auto& row : m.m)
        if (!std::all_of(row.begin(), row.end(), fitsFloat))
            throw ErrorAt(where_, "the transformation after " + quote(directive_) + " has numbers beyond 1e38");
}

void Parser::translate() {
    std::array<double, 3> v{};
    values_.readNumbers(directive_, v);
    multiply(translation(v[0], v[1], v[2]));
}

void Parser::scale() {
    std::array<double, 3> v{};
    values_.readNumbers(directive_, v);
    multiply(scaling(v[0], v[1], v[2]));
}

void Parser::rotate() {
    std::array<double, 4> v{};
    values_.readNumbers(directive_, v);
    if (v[1] == 0 && v[2] == 0 && v[3] == 0) throw ErrorAt(where_, "the axis of 'Rotate' is zero");
    multiply(rotation(v[0], v[1], v[2], v[3]));
}

void Parser::lookAt() {
    std::array<double, 9> v{};
    values_.readNumbers(directive_, v);
    Matrix4 m;
    if (!penumbra::lookAt({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}, m))
        throw ErrorAt(where_,
                      "'LookAt' gives no direction: the eye is at the target, or 'up' is zero or along the view");
    multiply(m);
}

/// Sixteen numbers, column by column. The last row has to be 0 0 0 w; w is divided out.
Matrix4 Parser::readMatrix() {
    std::array<double, 16> v{};
    values_.readNumbers(directive_, v);
    const double w = v[15];
    const double largest =
        std::abs(*std::max_element(v.begin(), v.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
    const auto negligible = [&](double value) { return std::abs(value) <= 1e-6 * largest; };
    if (w == 0 || !negligible(v[3]) || !negligible(v[7]) || !negligible(v[11]))
        throw ErrorAt(where_,
                      "the matrix of " + quote(directive_) +
                          " is no affine one: the 4th, 8th and 12th number have to be 0, the 16th not (the numbers "
                          "go column by column)");
    Matrix4 m;
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 3; ++row)
            m.m[row][column] = v[4 * column + row] / w;
    return m;
}

void Parser::transform() {
    const Matrix4 m = readMatrix();
    identity();
    multiply(m);
}

void Parser::concatTransform() {
    multiply(readMatrix());
}

void Parser::coordinateSystem() {
    context_.coordinateSystems[values_.readName("the name of the coordinate system")] = state().ctm;
}

void Parser::coordSysTransform() {
    const std::string name = values_.readName("the name of the coordinate system");
    const auto found = context_.coordinateSystems.find(name);
    if (found != context_.coordinateSystems.end()) {
        state().ctm = found->second;
        return;
    }
    std::vector<std::string> known;
    for (const auto& entry : context_.coordinateSystems)
        known.push_back(entry.first);
    warn("unknown coordinate system " + quote(name) + suggestion(name, known) + " (the directive is ignored)");
}

void Parser::activeTransform() {
    static const std::vector<std::string> known{"StartTime", "EndTime", "All"};
    const Token token = sources_.next();
    const bool isWord = token.kind == TokenKind::Word;
    if (!isWord || std::find(known.begin(), known.end(), token.text) == known.end())
        throw ErrorAt(token.where, "expected StartTime, EndTime or All, found " + describe(token));
    state().startActive = token.text != "EndTime";
    state().endActive = token.text != "StartTime";
}

void Parser::transformTimes() {
    std::array<double, 2> times{};
    values_.readNumbers(directive_, times);
    if (times[1] < times[0]) throw ErrorAt(where_, "the second of 'TransformTimes' lies before the first");
    std::copy(times.begin(), times.end(), scene_.transformTimes);
}

void Parser::attribute() {
    static const std::vector<std::string> kinds{"shape", "light", "material", "medium", "texture"};  // as Defaults
    const SourcePosition kindWhere = sources_.peek().where;
    const std::string kind = values_.readString("the kind of the attribute");
    const auto found = std::find(kinds.begin(), kinds.end(), kind);
    if (found == kinds.end())
        throw ErrorAt(kindWhere, "unknown kind of attribute " + quote(kind) + suggestion(kind, kinds));
    const ParameterSet added = readParameters();
    auto& defaults = state().defaults[static_cast<std::size_t>(found - kinds.begin())];
    auto all = defaults ? *defaults : std::vector<Parameter>();
    for (Parameter p : added.all()) {
        std::erase_if(all, [&](const Parameter& earlier) { return earlier.name == p.name; });
        p.inherited = true;
        all.push_back(std::move(p));
    }
    if (all.size() > ValueReader::kMostParameters)
        throw ErrorAt(where_, "more than " + std::to_string(ValueReader::kMostParameters) + " attributes of one kind");
    defaults = std::make_shared<const std::vector<Parameter>>(std::move(all));
}

void Parser::colorSpace() {
    static const std::vector<std::string> known{"srgb", "rec2020", "aces2065-1", "dci-p3"};
    const std::string name = values_.readString("the name of the colour space");
    const std::string canonical = lowerCase(name);
    if (std::find(known.begin(), known.end(), canonical) == known.end())
        warn("unknown colour space " + quote(name) + suggestion(name, known) + " (the directive is ignored)");
    else
        state().colorSpace = canonical;
}

void Parser::include() {
    const SourcePosition nameWhere = sources_.peek().where;
    sources_.include(values_.readString("the name of the file"), nameWhere);
}

/// Parsed with a copy of the state and nothing else of ours; only what it defines stays.
void Parser::import() {
    const SourcePosition nameWhere = sources_.peek().where;
    const std::string name = values_.readString("the name of the file");
    if (context_.object >= 0) throw ErrorAt(where_, "'Import' inside 'ObjectBegin'");
    Context outer = std::exchange(context_, Context{state(), {}, {}, -1});
    const std::size_t outerFloor = sources_.beginPart(name, nameWhere);
    readDirectives();
    sources_.endPart(outerFloor);
    context_ = std::move(outer);
}

}  // namespace penumbra::pbrt
