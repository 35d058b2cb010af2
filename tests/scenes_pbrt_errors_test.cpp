// Bad scene texts: the message of each, its place included.
#include "scenes/readers.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

struct Case {
    std::string text, message;
};

std::string messageOf(const std::string& text) {
    try {
        Warnings warnings;
        readSceneText(text, "s.pbrt", "", warnings);
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::BadData);
        return e.what();
    }
    return "no error";
}

void expectMessages(const std::vector<Case>& cases) {
    for (const Case& c : cases)
        EXPECT_EQ(messageOf(c.text), c.message) << c.text.substr(0, 200);
}

/// As expectMessages, after "WorldBegin" on a line of its own.
void expectWorldMessages(const std::vector<Case>& cases) {
    for (const Case& c : cases)
        EXPECT_EQ(messageOf("WorldBegin\n" + c.text), c.message) << c.text.substr(0, 200);
}

std::string repeated(const std::string& text, std::size_t times) {
    std::string out;
    for (std::size_t i = 0; i < times; ++i)
        out += text;
    return out;
}

TEST(ScenesPbrtErrors, WholeTexts) {
    using namespace std::string_literals;
    expectMessages({
        {"", "s.pbrt:1:1: expected 'WorldBegin', found the end of the file"},
        {" \n\t# nothing\n  ", "s.pbrt:3:3: expected 'WorldBegin', found the end of the file"},
        {"\xef\xbb\xbf", "s.pbrt:1:1: expected 'WorldBegin', found the end of the file"},
        {"\xff\xfeW\0o\0"s, "s.pbrt:1:1: the text is UTF-16; a scene has to be UTF-8"},
        {"WorldBegin\n # a\0b"s, "s.pbrt:2:5: a NUL byte: this is no text in UTF-8"},
        {"Film \"rgb", "s.pbrt:1:6: the string 'rgb' has no closing quote on its line"},
        {"\x7f"
         "ELF\x02",
         "s.pbrt:1:1: unknown directive '\\x7fELF\\x02'" +
             messageOf("zzzzz~").substr(std::string("s.pbrt:1:1: unknown directive 'zzzzz~'").size())},
        {std::string(1000000, 'S') + " 1",
         "s.pbrt:1:1: unknown directive '" + std::string(60, 'S') + "...'" +
             messageOf("zzzzz~").substr(std::string("s.pbrt:1:1: unknown directive 'zzzzz~'").size())},
    });
}

TEST(ScenesPbrtErrors, Directives) {
    expectMessages({
        {"Shpae! \"sphere\"", "s.pbrt:1:1: unknown directive 'Shpae!'; did you mean 'Shape'?"},
        {"WorldBegin\n  Translte: 0 0 1", "s.pbrt:2:3: unknown directive 'Translte:'; did you mean 'Translate'?"},
        {"\"Film\"", "s.pbrt:1:1: expected a directive, found the string 'Film'"},
        {"Translate 1 2 3 4", "s.pbrt:1:17: expected a directive, found '4' after 'Translate'"},
        {"Film \"rgb\" [ 1 ]", "s.pbrt:1:12: expected a directive, found '[' after 'Film'"},
        {"Shape \"sphere\"", "s.pbrt:1:1: 'Shape' has to come after 'WorldBegin'"},
        {"AttributeBegin", "s.pbrt:1:1: 'AttributeBegin' has to come after 'WorldBegin'"},
        {" WorldBegin\nCamera \"perspective\"",
         "s.pbrt:2:1: 'Camera' has to come before 'WorldBegin', which is at s.pbrt:1:2"},
        {"WorldBegin WorldBegin", "s.pbrt:1:12: 'WorldBegin' has to come before 'WorldBegin', which is at s.pbrt:1:1"},
        {"Film rgb", "s.pbrt:1:6: expected the type of the film in quotes, found 'rgb'"},
        {"Sampler", "s.pbrt:1:8: expected the type of the sampler in quotes, found the end of the file"},
        {"ActiveTransform Start", "s.pbrt:1:17: expected StartTime, EndTime or All, found 'Start'"},
        {"TransformTimes 1 0", "s.pbrt:1:1: the second of 'TransformTimes' lies before the first"},
        {"Attribute \"shpe\" \"float a\" 1", "s.pbrt:1:11: unknown kind of attribute 'shpe'; did you mean 'shape'?"},
        {"Option \"seed\" 1.5", "s.pbrt:1:15: expected an integer, found '1.5'"},
        {"Option \"wavefront\" 1", "s.pbrt:1:20: expected true or false, found '1'"},
        {"Include 3", "s.pbrt:1:9: expected the name of the file in quotes, found '3'"},
    });
}

TEST(ScenesPbrtErrors, Transforms) {
    expectMessages({
        {"Translate 1 2", "s.pbrt:1:14: 'Translate' needs 3 numbers, but after 2 comes the end of the file"},
        {"Scale 1 2 Film", "s.pbrt:1:11: 'Scale' needs 3 numbers, but after 2 comes 'Film'"},
        {"Scale 1 x 2", "s.pbrt:1:9: 'Scale' needs 3 numbers, but after 1 comes 'x'"},
        {"Scale 1 1x 2", "s.pbrt:1:9: expected a number, found '1x'"},
        {"Scale [1 2 3", "s.pbrt:1:13: expected ']' after the 3 numbers of 'Scale', found the end of the file"},
        {"Transform [1 0 0 0]", "s.pbrt:1:19: 'Transform' needs 16 numbers, but after 4 comes ']'"},
        {"Translate 0 0 1e400", "s.pbrt:1:15: the number '1e400' is out of range (at most 1.8e308)"},
        {"Translate nan 0 0", "s.pbrt:1:11: 'Translate' needs 3 numbers, but after 0 comes 'nan'"},
        {"Scale 1 0 1", "s.pbrt:1:1: the matrix of 'Scale' has no inverse"},
        {"Rotate 30 0 0 0", "s.pbrt:1:1: the axis of 'Rotate' is zero"},
        {"LookAt 1 1 1  1 1 1  0 1 0",
         "s.pbrt:1:1: 'LookAt' gives no direction: the eye is at the target, or 'up' is zero or along the view"},
        {"LookAt 0 0 0  0 5 0  0 1 0",
         "s.pbrt:1:1: 'LookAt' gives no direction: the eye is at the target, or 'up' is zero or along the view"},
        {"Transform [1 2 3 0 4 5 6 0 7 8 9 0 0 0 0 1]", "s.pbrt:1:1: the matrix of 'Transform' has no inverse"},
        {"ConcatTransform [1 0 0 5  0 1 0 0  0 0 1 0  0 0 0 1]",
         "s.pbrt:1:1: the matrix of 'ConcatTransform' is no affine one: the 4th, 8th and 12th number have to be 0, the "
         "16th "
         "not (the numbers go column by column)"},
        {repeated("Scale 1e10 1e10 1e10 ", 5), "s.pbrt:1:64: the transformation after 'Scale' has numbers beyond 1e38"},
    });
}

TEST(ScenesPbrtErrors, Parameters) {
    expectWorldMessages({
        {"Shape \"s\" \"radius\" 1", "s.pbrt:2:11: expected a parameter as \"type name\", found the string 'radius'"},
        {"Shape \"s\" \"float a b\" 1",
         "s.pbrt:2:11: expected a parameter as \"type name\", found the string 'float a b'"},
        {"Shape \"s\" \"\" 1", "s.pbrt:2:11: expected a parameter as \"type name\", found the string ''"},
        {"Shape \"s\" \"flaot radius\" 1",
         "s.pbrt:2:11: unknown type 'flaot' of parameter 'radius'; did you mean 'float'?"},
        {"Shape \"s\"\n \"xyz L\" [1 1 1]",
         "s.pbrt:3:2: unknown type 'xyz' of parameter 'L'; known: float, integer, bool, string, point2, vector2, "
         "point3, "
         "vector3, normal, rgb, blackbody, spectrum, texture"},
        {"Shape \"s\" \"float a\" \"1\"", "s.pbrt:2:21: expected a number or '[', found the string '1'"},
        {"Shape \"s\" \"float a\"", "s.pbrt:2:20: expected a number or '[', found the end of the file"},
        {"Shape \"s\" \"float a\" Shape", "s.pbrt:2:21: expected a number, found 'Shape'"},
        {"Shape \"s\" \"float a\" [1 2\nShape \"t\"",
         "s.pbrt:3:1: expected a number, found 'Shape', in the list that begins at s.pbrt:2:21"},
        {"Shape \"s\" \"float a\" [1 \"x\"]",
         "s.pbrt:2:24: expected a value or ']', found the string 'x', in the list that begins at s.pbrt:2:21"},
        {"Shape \"s\" \"float a\" [[1]]",
         "s.pbrt:2:22: expected a value or ']', found '[', in the list that begins at s.pbrt:2:21"},
        {"Shape \"s\" \"float a\" [1 2", "s.pbrt:2:21: the list has no closing ']'"},
        {"Shape \"s\" \"string a\" [\"1\" \"2\"", "s.pbrt:2:22: the list has no closing ']'"},
        {"Shape \"s\" \"float a\" []", "s.pbrt:2:11: parameter 'float a' has no value"},
        {"Shape \"s\" \"float a\" ]", "s.pbrt:2:21: expected a number or '[', found ']'"},
        {"Shape \"s\" \"float a\" 1e39", "s.pbrt:2:21: the number '1e39' is out of range (at most 3.4e38)"},
        {"Shape \"s\" \"float a\" [0 inf]",
         "s.pbrt:2:24: expected a number, found 'inf', in the list that begins at s.pbrt:2:21"},
        {"Shape \"s\" \"float a\" [1,2]",
         "s.pbrt:2:22: expected a number, found '1,2', in the list that begins at s.pbrt:2:21"},
        {"Shape \"s\" \"integer a\" 1.0", "s.pbrt:2:23: expected an integer, found '1.0'"},
        {"Shape \"s\" \"integer a\" 2147483648", "s.pbrt:2:23: the number '2147483648' does not fit a 32-bit integer"},
        {"Shape \"s\" \"bool a\" \"maybe\"", "s.pbrt:2:20: expected true or false, found the string 'maybe'"},
        {"Shape \"s\" \"string a\" true", "s.pbrt:2:22: expected a string in quotes, found 'true'"},
        {"Shape \"s\" \"point3 P\" [1 2 3 4]",
         "s.pbrt:2:11: parameter 'point3 P' needs numbers in groups of 3, but has 4"},
        {"Shape \"s\" \"point2 uv\" 1", "s.pbrt:2:11: parameter 'point2 uv' needs numbers in groups of 2, but has 1"},
        {"Shape \"s\" \"spectrum s\" [400 1 500]",
         "s.pbrt:2:11: parameter 'spectrum s' needs numbers in groups of 2, but has 3"},
        {"Shape \"s\" \"spectrum s\" [400 \"x\"]", "s.pbrt:2:29: a spectrum is either numbers or a name, not both"},
        {"Shape \"s\" \"texture t\" [\"a\" \"b\"]",
         "s.pbrt:2:11: parameter 'texture t' needs the name of one texture, but has 2"},
        {"Shape \"s\" \"rgb c\" [1 -2 1]", "s.pbrt:2:11: parameter 'rgb c' has the negative value -2.000000"},
        {"Shape \"s\" \"string a\" \"\\q\"",
         R"(s.pbrt:2:23: unknown escape '\q' in a string; known: \b \f \n \r \t \\ \' \")"},
        {"Shape \"s\" " + repeated("\"float a\" 1 ", 2) +
             [] {
                 std::string many;
                 for (int i = 0; i < 300; ++i)
                     many += "\"float a" + std::to_string(i) + "\" 1 ";
                 return many;
             }(),
         "s.pbrt:2:3750: more than 256 parameters in one directive"},
    });
}

TEST(ScenesPbrtErrors, BlocksAndNames) {
    expectWorldMessages({
        {"AttributeEnd", "s.pbrt:2:1: 'AttributeEnd' ends no block"},
        {"ObjectEnd", "s.pbrt:2:1: 'ObjectEnd' ends no block"},
        {"AttributeBegin\n TransformEnd",
         "s.pbrt:3:2: expected 'AttributeEnd' for the 'AttributeBegin' at s.pbrt:2:1, found 'TransformEnd'"},
        {"ObjectBegin \"o\" AttributeBegin ObjectEnd",
         "s.pbrt:2:32: expected 'AttributeEnd' for the 'AttributeBegin' at s.pbrt:2:17, found 'ObjectEnd'"},
        {"ObjectBegin \"o\"", "s.pbrt:2:1: 'ObjectBegin' has no 'ObjectEnd'"},
        {"ObjectBegin \"o\" ObjectBegin \"p\"", "s.pbrt:2:17: 'ObjectBegin' inside the object 'o'"},
        {"ObjectBegin \"o\" ObjectInstance \"p\"", "s.pbrt:2:17: 'ObjectInstance' inside 'ObjectBegin'"},
        {"ObjectBegin \"o\" Import \"x.pbrt\"", "s.pbrt:2:17: 'Import' inside 'ObjectBegin'"},
        {"ObjectBegin \"o\" ObjectEnd ObjectBegin \"o\" ObjectEnd",
         "s.pbrt:2:27: the object 'o' is defined already at s.pbrt:2:1"},
        {"MakeNamedMaterial \"m\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"m\" \"string type\" \"diffuse\"",
         "s.pbrt:3:1: the material 'm' is defined already at s.pbrt:2:1"},
        {"MakeNamedMaterial \"m\" \"float roughness\" 1", "s.pbrt:2:1: the material has no parameter \"string type\""},
        {"MakeNamedMedium \"m\"", "s.pbrt:2:1: the medium has no parameter \"string type\""},
        {"MakeNamedMedium \"m\" \"string type\" \"cloud\" MakeNamedMedium \"m\" \"string type\" \"cloud\"",
         "s.pbrt:2:43: the medium 'm' is defined already at s.pbrt:2:1"},
        {"Texture \"t\" \"float\" \"constant\" Texture \"t\" \"float\" \"constant\"",
         "s.pbrt:2:32: the float texture 't' is defined already at s.pbrt:2:1"},
        {"Texture \"t\" \"rgb\" \"constant\"",
         "s.pbrt:2:13: expected \"float\" or \"spectrum\" as the kind of the texture, found 'rgb'"},
        {"MediumInterface", "s.pbrt:2:16: expected the name of the inside medium in quotes, found the end of the file"},
        {repeated("AttributeBegin\n", 5000), "s.pbrt:4098:1: blocks are nested more than 4096 deep"},
    });
}

TEST(ScenesPbrtErrors, InheritanceCannotExplode) {
    std::string numbers;
    for (int i = 0; i < 1000000; ++i)
        numbers += "1 ";
    EXPECT_NE(
        messageOf("WorldBegin Attribute \"shape\" \"float x\" [" + numbers + "]\n" + repeated("Shape \"s\"\n", 100))
            .find(": what directives inherit from 'Attribute' and from the state takes more than 128 MiB"),
        std::string::npos);
    EXPECT_NE(
        messageOf("WorldBegin NamedMaterial \"" + std::string(1 << 20, 'n') + "\"\n" + repeated("Shape \"s\"\n", 200))
            .find(" takes more than 128 MiB"),
        std::string::npos);
}

}  // namespace
}  // namespace penumbra
