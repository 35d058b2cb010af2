#include "scenes/pbrt/parser.h"

#include <algorithm>

namespace penumbra::pbrt {

namespace {

/// Whether a later version of the format could call a directive so.
bool looksLikeDirective(std::string_view word) {
    constexpr std::size_t kLongest = 100;
    constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    return word.size() <= kLongest && word.find_first_not_of(kLetters) == std::string_view::npos;
}

}  // namespace

const std::vector<Parser::Directive>& Parser::directives() {
    static const std::vector<Directive> table{
        {"Accelerator", Where::BeforeWorld, &Parser::accelerator},
        {"ActiveTransform", Where::Anywhere, &Parser::activeTransform},
        {"AreaLightSource", Where::InWorld, &Parser::areaLightSource},
        {"Attribute", Where::Anywhere, &Parser::attribute},
        {"AttributeBegin", Where::InWorld, &Parser::attributeBegin},
        {"AttributeEnd", Where::InWorld, &Parser::closeBlock},
        {"Camera", Where::BeforeWorld, &Parser::camera},
        {"ColorSpace", Where::Anywhere, &Parser::colorSpace},
        {"ConcatTransform", Where::Anywhere, &Parser::concatTransform},
        {"CoordSysTransform", Where::Anywhere, &Parser::coordSysTransform},
        {"CoordinateSystem", Where::Anywhere, &Parser::coordinateSystem},
        {"Film", Where::BeforeWorld, &Parser::film},
        {"Identity", Where::Anywhere, &Parser::identity},
        {"Import", Where::InWorld, &Parser::import},
        {"Include", Where::Anywhere, &Parser::include},
        {"Integrator", Where::BeforeWorld, &Parser::integrator},
        {"LightSource", Where::InWorld, &Parser::lightSource},
        {"LookAt", Where::Anywhere, &Parser::lookAt},
        {"MakeNamedMaterial", Where::InWorld, &Parser::makeNamedMaterial},
        {"MakeNamedMedium", Where::Anywhere, &Parser::makeNamedMedium},
        {"Material", Where::InWorld, &Parser::material},
        {"MediumInterface", Where::Anywhere, &Parser::mediumInterface},
        {"NamedMaterial", Where::InWorld, &Parser::namedMaterial},
        {"ObjectBegin", Where::InWorld, &Parser::objectBegin},
        {"ObjectEnd", Where::InWorld, &Parser::objectEnd},
        {"ObjectInstance", Where::InWorld, &Parser::objectInstance},
        {"Option", Where::Anywhere, &Parser::option},
        {"PixelFilter", Where::BeforeWorld, &Parser::pixelFilter},
        {"ReverseOrientation", Where::InWorld, &Parser::reverseOrientation},
        {"Rotate", Where::Anywhere, &Parser::rotate},
        {"Sampler", Where::BeforeWorld, &Parser::sampler},
        {"Scale", Where::Anywhere, &Parser::scale},
        {"Shape", Where::InWorld, &Parser::shape},
        {"Texture", Where::InWorld, &Parser::texture},
        {"Transform", Where::Anywhere, &Parser::transform},
        {"TransformBegin", Where::InWorld, &Parser::transformBegin},
        {"TransformEnd", Where::InWorld, &Parser::closeBlock},
        {"TransformTimes", Where::BeforeWorld, &Parser::transformTimes},
        {"Translate", Where::Anywhere, &Parser::translate},
        {"WorldBegin", Where::BeforeWorld, &Parser::worldBegin},
        {"WorldEnd", Where::InWorld, &Parser::worldEnd},
    };
    return table;
}

/// The table is in the order of names.
const Parser::Directive* Parser::findDirective(std::string_view name) {
    const std::vector<Directive>& all = directives();
    const auto before = [](const Directive& d, std::string_view other) { return d.name < other; };
    const auto found = std::lower_bound(all.begin(), all.end(), name, before);
    return found != all.end() && found->name == name ? &*found : nullptr;
}

void Parser::run() {
    setDefaults();
    readDirectives();
    if (worldBegan_.line == 0) throw ErrorAt(sources_.peek().where, "expected 'WorldBegin', found the end of the file");
}

void Parser::readDirectives() {
    for (;;) {
        const Token token = sources_.next();
        if (token.kind == TokenKind::End) return closeBlocksAtEnd();
        const Directive* d = token.kind == TokenKind::Word ? findDirective(token.text) : nullptr;
        if (!d) {
            skipUnknown(token);
            continue;
        }
        directive_ = d->name;
        where_ = token.where;
        checkPlace(*d);
        (this->*d->read)();
    }
}

/// Passes over the directive and its values with a warning; throws where this is no directive at all.
void Parser::skipUnknown(const Token& token) {
    if (token.kind != TokenKind::Word || looksLikeNumber(token.text))
        throw ErrorAt(token.where, "expected a directive, found " + describe(token) +
                                       (directive_.empty() ? "" : " after " + quote(directive_)));
    std::vector<std::string> names;
    for (const Directive& d : directives())
        names.emplace_back(d.name);
    const std::string message = "unknown directive " + quote(token.text) + suggestion(token.text, names);
    if (!looksLikeDirective(token.text) || ++unknownDirectives_ > kMostUnknown) throw ErrorAt(token.where, message);
    warnings_.add(scene_.position(token.where) + ": " + message + " (it is skipped with its values)");
    values_.skipValues();
}

void Parser::checkPlace(const Directive& d) const {
    const bool inWorld = worldBegan_.line > 0;
    if (d.where == Where::BeforeWorld && inWorld)
        throw ErrorAt(where_,
                      quote(d.name) + " has to come before 'WorldBegin', which is at " + scene_.position(worldBegan_));
    if (d.where == Where::InWorld && !inWorld) throw ErrorAt(where_, quote(d.name) + " has to come after 'WorldBegin'");
}

/// At the end of the scene or of an imported part nothing is left that an open attribute block could change, so it is
/// closed there with a warning; an object may lack shapes.
void Parser::closeBlocksAtEnd() {
    for (const Block& block : context_.blocks) {
        const std::string message = quote(block.beganWith) + " has no " + quote(block.endsWith);
        if (block.beganWith == "ObjectBegin") throw ErrorAt(block.where, message);
        warnings_.add(scene_.position(block.where) + ": " + message + " (the end of the file closes it)");
    }
}

void Parser::openBlock(std::string_view beganWith, std::string_view endsWith) {
    if (context_.blocks.size() >= kDeepestBlocks)
        throw ErrorAt(where_, "blocks are nested more than " + std::to_string(kDeepestBlocks) + " deep");
    chargeNames();
    context_.blocks.push_back({beganWith, endsWith, where_, state()});
}

void Parser::closeBlock() {
    if (context_.blocks.empty()) throw ErrorAt(where_, quote(directive_) + " ends no block");
    Block& block = context_.blocks.back();
    if (block.endsWith != directive_)
        throw ErrorAt(where_, "expected " + quote(block.endsWith) + " for the " + quote(block.beganWith) + " at " +
                                  scene_.position(block.where) + ", found " + quote(directive_));
    state() = std::move(block.saved);
    context_.blocks.pop_back();
}

void Parser::warn(const std::string& text) {
    warnings_.add(scene_.position(where_) + ": " + text);
}

void Parser::define(Names& names, const std::string& name, std::string_view what) {
    const auto [entry, isNew] = names.emplace(name, where_);
    if (!isNew)
        throw ErrorAt(where_, "the " + std::string(what) + " " + quote(name) + " is defined already at " +
                                  scene_.position(entry->second));
}

void Parser::charge(std::uint64_t inherited) {
    inheritedBytes_ += std::max(inherited, kFreelyInherited) - kFreelyInherited;
    if (inheritedBytes_ > kMostInherited)
        throw ErrorAt(where_, "what directives inherit from 'Attribute' and from the state takes more than " +
                                  std::to_string(kMostInherited >> 20) + " MiB");
}

Entity Parser::readEntity(std::string_view what) {
    Entity entity;
    entity.where = where_;
    entity.type = readTypeOf(what);
    entity.parameters = readParameters();
    return entity;
}

/// The directive's own parameters behind those that Attribute directives gave; an inherited one gives way to an own one
/// of the same name, whatever its type.
ParameterSet Parser::readParametersWith(Defaults kind) {
    ParameterSet own = readParameters();
    const auto& defaults = state().defaults[static_cast<std::size_t>(kind)];
    if (!defaults) return own;
    ParameterSet all;
    std::uint64_t bytes = 0;
    for (const Parameter& inherited : *defaults) {
        const auto replaces = [&](const Parameter& p) { return p.name == inherited.name; };
        if (std::any_of(own.all().begin(), own.all().end(), replaces)) continue;
        bytes += sizeof(Parameter) + sizeof(float) * inherited.count();
        charge(bytes);
        all.add(inherited);
    }
    for (Parameter& p : own.all())
        all.add(std::move(p));
    return all;
}

std::string Parser::takeTypeParameter(const ParameterSet& parameters, std::string_view what) const {
    const Parameter* type = parameters.find("string", "type");
    if (!type) throw ErrorAt(where_, "the " + std::string(what) + " has no parameter \"string type\"");
    return type->strings().front();
}

}  // namespace penumbra::pbrt
