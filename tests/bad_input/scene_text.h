// Bad scene texts. The comments number the cases as the project's list of hostile inputs does.
#pragma once

#include "tests/bad_input/bad_input.h"

namespace penumbra::bad_input {

inline std::vector<Case> encodingCases() {
    using namespace std::string_literals;
    const std::string nothing = "expected 'WorldBegin', found the end of the file";
    return {
        {"empty file", scene(""), 65, "error: scene.pbrt:1:1: " + nothing},
        {"white space only", scene(" \t\r\n\n  "), 65, "error: scene.pbrt:3:3: " + nothing},
        {"byte order mark only", scene("\xef\xbb\xbf"), 65, "error: scene.pbrt:1:1: " + nothing},
        {"byte order mark before a scene", scene("\xef\xbb\xbf" + kHead + "WorldBegin LightSource \"infinite\""), 0, ""},
        {"NUL byte", scene("WorldBegin\n # a\0b"s), 65, "error: scene.pbrt:2:5: a NUL byte"},
        {"invalid UTF-8 in a string", world("Material \"diff\xff\""), 65,
         "error: scene.pbrt:2:15: the string is not valid UTF-8"},
        {"overlong UTF-8 in a string", world("Material \"\xc0\xaf\""), 65,
         "error: scene.pbrt:2:11: the string is not valid UTF-8"},
        {"invalid UTF-8 in a comment", world("# \xff\xfe\n"), 0, ""},
        {"invalid UTF-8 outside", world("\xff\xfe\xfd"), 65, "error: scene.pbrt:2:1: "},
        {"UTF-16, little-endian", scene("\xff\xfeW\0o\0"s), 65, "error: scene.pbrt:1:1: the text is UTF-16"},
        {"UTF-16, big-endian", scene("\xfe\xff\0W\0o"s), 65, "error: scene.pbrt:1:1: the text is UTF-16"},
        {"UTF-16 without a mark", scene("W\0o\0r\0l\0d\0"s), 65, "error: scene.pbrt:1:2: a NUL byte"},
        {"lines end in CR LF", world("AttributeBegin\r\n# comment\r\nShape \"sphere\"\r\nAttributeEnd\r\n"), 0, ""},
        {"lines end in CR", world("AttributeBegin\r# comment\rShape \"sphere\"\rAttributeEnd\r"), 0, ""},
        {"lines end in CR, and an error", world("\rShape\r  sphere"), 65, "error: scene.pbrt:4:3: expected the type"},
        {"a line of 100 MB of blanks", scene([] { return std::string(100000000, ' ') + "Shap \"x\""; }), 65,
         "warning: scene.pbrt:1:100000001: unknown directive 'Shap'"},
        {"a word of 100 MB", scene([] { return std::string(100000000, 'S') + " 1"; }), 65,
         "error: scene.pbrt:1:1: unknown directive 'SSSSS"},
        {"a string of 100 MB", scene([] { return "Film \"" + std::string(100000000, 's'); }), 65,
         "error: scene.pbrt:1:6: the string 'sssss"},
        {"a program", scene("\x7f"
                            "ELF\x02\x01\x01"),
         65, "error: scene.pbrt:1:1: unknown directive '\\x7fELF\\x02\\x01\\x01'"},
        {"JSON", scene("{\"asset\": {\"version\": \"2.0\"}}"), 65, "error: scene.pbrt:1:1: unknown directive '{'"},
    };
}

inline std::vector<Case> syntaxCases() {
    const std::string sphere = "Shape \"sphere\" ";
    return {
        {"string without end", world("Material \"diffuse\nShape \"sphere\""), 65,
         "error: scene.pbrt:2:10: the string 'diffuse' has no closing quote"},
        // Some exporters leave a block open; nothing is left that it could change.
        {"block without end", world("AttributeBegin\nShape \"sphere\""), 0,
         "warning: scene.pbrt:2:1: 'AttributeBegin' has no 'AttributeEnd' (the end of the file closes it)"},
        {"block without end, strict", world("AttributeBegin\nShape \"sphere\""), 65,
         "error: scene.pbrt:2:1: 'AttributeBegin' has no 'AttributeEnd'", {"--strict"}},
        {"object without end", world("ObjectBegin \"o\"\nShape \"sphere\""), 65,
         "error: scene.pbrt:2:1: 'ObjectBegin' has no 'ObjectEnd'"},
        {"end of no block", world("AttributeEnd"), 65, "error: scene.pbrt:2:1: 'AttributeEnd' ends no block"},
        {"blocks that cross", world("AttributeBegin ObjectBegin \"o\" AttributeEnd"), 65,
         "error: scene.pbrt:2:32: expected 'ObjectEnd' for the 'ObjectBegin' at scene.pbrt:2:16"},
        {"unknown directive", world("Shpae \"sphere\" \"float radius\" [1 2] \"bool b\" true 5\nShape \"sphere\""), 0,
         "warning: scene.pbrt:2:1: unknown directive 'Shpae'; did you mean 'Shape'?"},
        {"unknown directive, strict", world("Shpae \"sphere\""), 65,
         "error: scene.pbrt:2:1: unknown directive 'Shpae'; did you mean 'Shape'?", {"--strict"}},
        {"unknown parameter", world(sphere + "\"float radios\" 1"), 0,
         "warning: scene.pbrt:2:16: parameter 'float radios' of shape 'sphere' is unknown; did you mean 'radius'?"},
        {"unknown parameter, strict", world(sphere + "\"float radios\" 1"), 65,
         "error: scene.pbrt:2:16: parameter 'float radios' of shape 'sphere' is unknown", {"--strict"}},
        {"unknown type of parameter", world(sphere + "\"flaot radius\" 1"), 65,
         "error: scene.pbrt:2:16: unknown type 'flaot' of parameter 'radius'; did you mean 'float'?"},
        // The format takes the last of two, so scenes that say a thing twice are no wrong scenes.
        {"parameter twice", world(sphere + "\"float radius\" 1 \"float radius\" 2"), 0,
         "warning: scene.pbrt:2:33: parameter 'float radius' replaces"},
        {"parameter twice, strict", world(sphere + "\"float radius\" 1 \"float radius\" 2"), 65,
         "error: scene.pbrt:2:33: parameter 'float radius' replaces", {"--strict"}},
        {"declared of another type", world(sphere + "\"integer radius\" 1"), 0,
         "warning: scene.pbrt:2:16: parameter 'integer radius' of shape 'sphere' is ignored: it has to be of type float"},
        {"value of another type", world(sphere + "\"float radius\" \"1\""), 65, "error: scene.pbrt:2:31: expected a number"},
        {"no value", world(sphere + "\"float radius\" []"), 65, "error: scene.pbrt:2:16: parameter 'float radius' has no"},
        {"two values for one", world(sphere + "\"float radius\" [1 2]"), 65,
         "error: scene.pbrt:2:16: 'float radius' must be one value"},
        {"half a point", world("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0]"), 65,
         "error: scene.pbrt:2:22: parameter 'point3 P' needs numbers in groups of 3, but has 5"},
        {"too few numbers of a directive", world("Translate 1 2\n" + sphere), 65, "error: scene.pbrt:3:1: 'Translate'"},
        {"too many numbers of a directive", world("Translate 1 2 3 4"), 65, "error: scene.pbrt:2:17: expected a directive"},
        {"list without end", world(sphere + "\"float radius\" [1 2"), 65, "error: scene.pbrt:2:31: the list has no closing"},
        {"number beyond double", world("Translate 0 0 1e400"), 65,
         "error: scene.pbrt:2:15: the number '1e400' is out of range"},
        {"number beyond float", world(sphere + "\"float radius\" 1e39"), 65,
         "error: scene.pbrt:2:31: the number '1e39' is out of range"},
        {"nan", world(sphere + "\"float radius\" nan"), 65, "error: scene.pbrt:2:31: expected a number, found 'nan'"},
        {"inf", world(sphere + "\"float radius\" [ inf ]"), 65, "error: scene.pbrt:2:33: expected a number, found 'inf'"},
        {"-nan(0x1)", world(sphere + "\"float radius\" -nan(0x1)"), 65, "error: scene.pbrt:2:31: expected a number"},
        {"hexadecimal float", world(sphere + "\"float radius\" 0x1.8p0"), 0, ""},
        {"decimal comma", world(sphere + "\"float radius\" 1,5"), 65, "error: scene.pbrt:2:31: expected a number, found '1,5'"},
        {"integer with a point", options("Film \"rgb\" \"integer xresolution\" 4.0"), 65,
         "error: scene.pbrt:2:34: expected an integer, found '4.0'"},
        {"integer 2^31", options("Film \"rgb\" \"integer xresolution\" 2147483648"), 65,
         "error: scene.pbrt:2:34: the number '2147483648' does not fit"},
        {"integer 2^63", options("Film \"rgb\" \"integer xresolution\" 9223372036854775808"), 65,
         "error: scene.pbrt:2:34: the number '9223372036854775808' does not fit"},
        {"blocks 10000 deep", world(repeated("AttributeBegin\n", 10000)), 65,
         "error: scene.pbrt:4098:1: blocks are nested more than 4096 deep"},
        {"a million unknown words", scene([] { return repeated("Nonsense\n", 1000000); }), 65,
         "warning: scene.pbrt:1:1: unknown directive 'Nonsense'"},
    };
}

inline std::vector<Case> settingsCases() {
    const auto film = [](const std::string& x, const std::string& y) {
        return scene("\nFilm \"rgb\" \"integer xresolution\" " + x + " \"integer yresolution\" " + y +
                     "\nWorldBegin LightSource \"infinite\"");
    };
    const auto samples = [](const std::string& n) { return options("Sampler \"sobol\" \"integer pixelsamples\" " + n); };
    const auto camera = [](const std::string& parameters) { return options("Camera \"perspective\" " + parameters); };
    return {
        {"resolution 0", film("0", "4"), 65, "error: scene.pbrt:2:12: xresolution is 0, outside the allowed range, 1 to"},
        {"resolution -1", film("4", "-1"), 65, "error: scene.pbrt:2:36: yresolution is -1, outside the allowed range, 1 to"},
        {"resolution 1x1", film("1", "1"), 0, ""},
        {"resolution 10^6 x 10^6", film("1000000", "1000000"), 65,
         "error: scene.pbrt:2:1: a film of 1000000 x 1000000 pixels is too large: it would take 8e+13 bytes"},
        {"empty crop", options("Film \"rgb\" \"float cropwindow\" [1 1 0 1]"), 65, "error: scene.pbrt:2:12: cropwindow leaves"},
        {"crop of three numbers", options("Film \"rgb\" \"float cropwindow\" [0 1 0]"), 65,
         "error: scene.pbrt:2:12: cropwindow needs 4 numbers"},
        {"samples 0", samples("0"), 65, "error: scene.pbrt:2:17: pixelsamples is 0, outside the allowed range, 1 to"},
        {"samples -1", samples("-1"), 65, "error: scene.pbrt:2:17: pixelsamples is -1, outside the allowed range, 1 to"},
        {"samples 2^31", samples("2147483648"), 65, "error: scene.pbrt:2:40: the number '2147483648' does not fit"},
        {"field of view 0", camera("\"float fov\" 0"), 65, "error: scene.pbrt:2:22: fov is 0, outside the allowed range"},
        {"field of view 180", camera("\"float fov\" 180"), 65, "error: scene.pbrt:2:22: fov is 180, outside the allowed"},
        {"field of view 360", camera("\"float fov\" 360"), 65, "error: scene.pbrt:2:22: fov is 360, outside the allowed"},
        {"field of view NaN", camera("\"float fov\" nan"), 65, "error: scene.pbrt:2:34: expected a number, found 'nan'"},
        {"focal distance 1e20", camera("\"float focaldistance\" 1e20 \"float lensradius\" 1"), 65,
         "error: scene.pbrt:2:22: focaldistance is 1e+20, outside the allowed range"},
        {"camera further away than rays reach", options("Translate 0 0 1e20 Camera \"perspective\""), 65,
         "error: scene.pbrt:2:20: "},
        {"camera scaled to nothing", options("Scale 1e30 1e30 1e30 Camera \"perspective\""), 65, "error: scene.pbrt:2:22: "},
        {"shutter closes before it opens", camera("\"float shutteropen\" 2 \"float shutterclose\" 1"), 65,
         "error: scene.pbrt:2:1: the shutter closes at 1"},
        {"filter of no width", options("PixelFilter \"box\" \"float xradius\" 0"), 65,
         "error: scene.pbrt:2:19: xradius is 0, outside the allowed range"},
        {"unknown sampler", options("Sampler \"sobl\""), 65,
         "error: scene.pbrt:2:1: unknown sampler 'sobl'; did you mean 'sobol' or 'zsobol'?"},
        {"matrix without inverse", world("Transform [1 2 3 0 4 5 6 0 7 8 9 0 0 0 0 1]"), 65,
         "error: scene.pbrt:2:1: the matrix of 'Transform' has no inverse"},
        {"matrix with nan", world("ConcatTransform [1 0 0 0 0 nan 0 0 0 0 1 0 0 0 0 1]"), 65, "error: scene.pbrt:2:28: "},
        {"scaling by 0", world("Scale 1 0 1"), 65, "error: scene.pbrt:2:1: the matrix of 'Scale' has no inverse"},
        {"rotation about nothing", world("Rotate 90 0 0 0"), 65, "error: scene.pbrt:2:1: the axis of 'Rotate' is zero"},
        {"eye at the target", options("LookAt 1 1 1  1 1 1  0 1 0"), 65, "error: scene.pbrt:2:1: 'LookAt' gives no direction"},
        {"up along the view", options("LookAt 0 0 0  0 5 0  0 1 0"), 65, "error: scene.pbrt:2:1: 'LookAt' gives no direction"},
    };
}

inline std::vector<Case> fileCases() {
    const std::vector<std::string> root{"--root", "."};
    const std::string longName(100000, 'x');
    return {
        {"no scene", {}, 66, "error: scene.pbrt: the file 'scene.pbrt' cannot be opened: No such file"},
        {"scene is a folder", {{"scene.pbrt/", ""}}, 65, "error: scene.pbrt: expected a file, but 'scene.pbrt' is a folder"},
        {"file includes itself", world("Include \"scene.pbrt\""), 65,
         "error: scene.pbrt:2:9: the file 'scene.pbrt' is being read already"},
        {"two files include each other", world("Include \"a.pbrt\"", {{"a.pbrt", "\n Include \"./scene.pbrt\""}}), 65,
         "error: a.pbrt:2:10: the file './scene.pbrt' is being read already"},
        {"imported file imports itself", world("Import \"a.pbrt\"", {{"a.pbrt", "Import \"a.pbrt\""}}), 65,
         "error: a.pbrt:1:8: the file 'a.pbrt' is being read already"},
        {"included file is missing", world("Include \"none.pbrt\""), 66,
         "error: scene.pbrt:2:9: the file 'none.pbrt' cannot be opened: No such file"},
        {"included file is a folder", world("Include \"sub\"", {{"sub/", ""}}), 65,
         "error: scene.pbrt:2:9: expected a file, but 'sub' is a folder"},
        {"included file is a device", world("Include \"/dev/zero\""), 66, "error: scene.pbrt:2:9: /dev/zero: is not a file"},
        {"link that leads nowhere", world("Include \"a.pbrt\"", {{"a.pbrt -> none", ""}}), 66, "error: scene.pbrt:2:9: "},
        {"link in a circle", world("Include \"a.pbrt\"", {{"a.pbrt -> b.pbrt", ""}, {"b.pbrt -> a.pbrt", ""}}), 66,
         "error: scene.pbrt:2:9: "},
        {"way out of the root", world("Include \"../../../../../../etc/passwd\""), 77,
         "error: scene.pbrt:2:9: the file '../../../../../../etc/passwd' lies outside the root", root},
        {"absolute path outside the root", world("Include \"/etc/passwd\""), 77,
         "error: scene.pbrt:2:9: the file '/etc/passwd' lies outside the root", root},
        {"import outside the root", world("Import \"/etc/passwd\""), 77,
         "error: scene.pbrt:2:8: the file '/etc/passwd' lies outside the root", root},
        {"link out of the root", world("Include \"a.pbrt\"", {{"a.pbrt -> /etc/passwd", ""}}), 77,
         "error: scene.pbrt:2:9: the file 'a.pbrt' lies outside the root", root},
        {"folder linked out of the root", world("Include \"etc/passwd\"", {{"etc -> /etc", ""}}), 77,
         "error: scene.pbrt:2:9: the file 'etc/passwd' lies outside the root", root},
        {"mesh outside the root", world("Shape \"plymesh\" \"string filename\" \"/etc/passwd\""), 77,
         "error: scene.pbrt:2:1: shape 'plymesh': the file '/etc/passwd' lies outside the root", root},
        {"image outside the root", world("LightSource \"infinite\" \"string filename\" \"/etc/passwd\""), 77,
         "error: scene.pbrt:2:1: light 'infinite': the file '/etc/passwd' lies outside the root", root},
        {"texture outside the root",
         world("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"/etc/passwd\"\n"
               "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\""),
         77, "error: scene.pbrt:2:1: texture 't': the file '/etc/passwd' lies outside the root", root},
        {"spectrum outside the root",
         world("Material \"conductor\" \"spectrum eta\" \"/etc/passwd\" Shape \"sphere\""), 77,
         "error: scene.pbrt:2:22: 'spectrum eta' of material 'conductor': the file '/etc/passwd' lies outside the root", root},
        {"scene outside the root", {{"scene.pbrt", "WorldBegin"}, {"sub/", ""}}, 77,
         "error: scene.pbrt: the file 'scene.pbrt' lies outside the root", {"--root", "sub"}},
        {"link within the root", world("Include \"a.pbrt\"", {{"a.pbrt -> b.pbrt", ""}, {"b.pbrt", "Shape \"sphere\""}}), 0,
         "", root},
        {"missing file within the root", world("Include \"none.pbrt\""), 66,
         "error: scene.pbrt:2:9: the file 'none.pbrt' cannot be opened: No such file", root},
        {"root that is not there", world(""), 66, "error: --root: ", {"--root", "none"}},
        {"path with a line feed", world("Include \"a\\nb.pbrt\""), 66,
         "error: scene.pbrt:2:9: the file 'a\\x0ab.pbrt' cannot be opened"},
        {"path of 100000 letters", world("Include \"" + longName + "\""), 66, "error: scene.pbrt:2:9: the file 'xxx"},
        {"mesh with a path of 100000 letters", world("Shape \"plymesh\" \"string filename\" \"" + longName + "\""), 66,
         "error: scene.pbrt:2:1: shape 'plymesh': "},
        {"URL", world("Include \"http://example.com/a.pbrt\""), 66,
         "error: scene.pbrt:2:9: the file 'http://example.com/a.pbrt' cannot be opened"},
        {"environment variable in a path", world("Include \"$HOME/a.pbrt\""), 66,
         "error: scene.pbrt:2:9: the file '$HOME/a.pbrt' cannot be opened"},
        {"tilde in a path", world("Include \"~/a.pbrt\""), 66, "error: scene.pbrt:2:9: the file '~/a.pbrt' cannot be opened"},
        {"command in a path", world("Include \"$(touch out.exr)\""), 66, "error: scene.pbrt:2:9: the file '$(touch out.exr)'"},
    };
}

inline std::vector<Case> meaningCases() {
    const auto material = [](const std::string& text) { return world("Material " + text + " Shape \"sphere\""); };
    const auto light = [](const std::string& text) { return world("LightSource " + text); };
    const auto sphere = [](const std::string& text) { return world("Shape \"sphere\" " + text); };
    const auto noise = [](const std::string& text) {
        return world("Texture \"t\" \"float\" \"fbm\" " + text +
                     "\nMaterial \"dielectric\" \"texture roughness\" \"t\" Shape \"sphere\"");
    };
    return {
        {"texture of itself",
         world("Texture \"t\" \"float\" \"scale\" \"texture tex\" \"t\"\nMaterial \"dielectric\" \"texture roughness\" \"t\"\n"
               "Shape \"sphere\""),
         65, "error: scene.pbrt:2:29: the texture 't' refers to itself"},
        {"two textures of each other",
         world("Texture \"a\" \"float\" \"scale\" \"texture tex\" \"b\"\nTexture \"b\" \"float\" \"scale\" \"texture tex\" "
               "\"a\"\nMaterial \"dielectric\" \"texture roughness\" \"a\" Shape \"sphere\""),
         65, "error: scene.pbrt:3:29: the texture 'a' refers to itself"},
        {"material of itself",
         world("MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [\"m\" \"m\"]\nNamedMaterial \"m\" "
               "Shape \"sphere\""),
         65, "error: scene.pbrt:2:43: the material 'm' refers to itself: 'm' is mixed of 'm'"},
        {"mix of a material that is not there",
         material("\"mix\" \"string materials\" [\"m\" \"m\"]"), 65, "error: scene.pbrt:2:16: unknown material 'm'"},
        {"mix of one", material("\"mix\" \"string materials\" \"m\""), 65,
         "error: scene.pbrt:2:1: material 'mix': a mix needs the names of two materials"},
        {"amount of a mix NaN", material("\"mix\" \"float amount\" nan"), 65, "error: scene.pbrt:2:31: expected a number"},
        {"object of itself", world("ObjectBegin \"o\"\nObjectInstance \"o\"\nObjectEnd"), 65,
         "error: scene.pbrt:3:1: 'ObjectInstance' inside 'ObjectBegin'"},
        {"unknown object", world("ObjectInstance \"o\""), 65, "error: scene.pbrt:2:1: unknown object 'o'"},
        {"unknown material", world("NamedMaterial \"m\"\nShape \"sphere\""), 65, "error: scene.pbrt:2:1: unknown material 'm'"},
        {"unknown texture", material("\"diffuse\" \"texture reflectance\" \"t\""), 65,
         "error: scene.pbrt:2:20: unknown spectrum texture 't'"},
        {"two billion octaves of noise", noise("\"integer octaves\" 2000000000"), 65,
         "error: scene.pbrt:2:1: texture 't': octaves 2000000000 is not between 0 and 32"},
        {"noise without end", noise("\"integer octaves\" 32 \"float roughness\" 1e38"), 0, ""},
        {"unknown medium", world("MediumInterface \"m\" \"\"\nShape \"sphere\""), 65,
         "error: scene.pbrt:2:1: unknown medium 'm'"},
        {"name twice", world("Texture \"t\" \"float\" \"constant\"\nTexture \"t\" \"float\" \"constant\""), 65,
         "error: scene.pbrt:3:1: the float texture 't' is defined already at scene.pbrt:2:1"},
        {"no lights", scene(kHead + "WorldBegin Shape \"sphere\""), 0,
         "warning: scene.pbrt: the scene has no lights: the picture will be black"},
        {"no shapes", world(""), 0, ""},
        {"a million lights", scene([] { return kHead + "WorldBegin\n" + repeated("LightSource \"point\"\n", 1000000); }), 0, ""},
        {"negative emission", light("\"point\" \"rgb I\" [-1 0 0]"), 65, "error: scene.pbrt:2:21: parameter 'rgb I' has the "
                                                                         "negative value -1"},
        {"negative scale of a light", light("\"point\" \"float scale\" -1"), 65, "error: scene.pbrt:2:21: scale is -1"},
        {"emission 1e38", light("\"point\" \"rgb I\" [1e38 1e38 1e38]"), 65, "error: scene.pbrt:2:1: light 'point'"},
        {"emission 1e38 of a shape", world("AreaLightSource \"diffuse\" \"rgb L\" [1e38 1e38 1e38]\nShape \"sphere\""), 65,
         "error: scene.pbrt:2:1: area light 'diffuse': the radiance is too large"},
        {"blackbody of 0 kelvin", light("\"point\" \"blackbody I\" 0"), 65, "error: scene.pbrt:2:21: "},
        {"light from nowhere", light("\"distant\" \"point3 from\" [0 0 0] \"point3 to\" [0 0 0]"), 65, "error: scene.pbrt:2:1: "},
        {"spotlight to nowhere", light("\"spot\" \"point3 from\" [1 0 0] \"point3 to\" [1 0 0]"), 65,
         "error: scene.pbrt:2:1: light 'spot': its points 'from' and 'to' give no direction"},
        {"spotlight beyond all directions", light("\"spot\" \"float coneangle\" 181"), 65,
         "error: scene.pbrt:2:20: coneangle is 181"},
        {"projector without a slide", light("\"projection\" \"float fov\" 30"), 65,
         "error: scene.pbrt:2:1: light 'projection': needs an image"},
        {"fov 0 of a projector", light("\"projection\" \"string filename\" \"a.png\" \"float fov\" 0"), 65,
         "error: scene.pbrt:2:51: fov is 0"},
        {"roughness -1", material("\"conductor\" \"float roughness\" -1"), 65, "error: scene.pbrt:2:1: material 'conductor': a roughness of -1"},
        {"roughness NaN", material("\"conductor\" \"float roughness\" nan"), 65, "error: scene.pbrt:2:40: expected a number"},
        {"roughness 2", material("\"conductor\" \"float roughness\" 2"), 65, "error: scene.pbrt:2:1: material 'conductor': a roughness of 2"},
        {"index of refraction 0", material("\"dielectric\" \"float eta\" 0"), 65, "error: scene.pbrt:2:23: "},
        {"index of refraction -1", material("\"dielectric\" \"float eta\" -1"), 65, "error: scene.pbrt:2:23: "},
        {"index of refraction NaN", material("\"dielectric\" \"float eta\" nan"), 65, "error: scene.pbrt:2:35: expected a"},
        {"albedo above 1", material("\"diffuse\" \"rgb reflectance\" [2 0 0]"), 65, "error: scene.pbrt:2:20: "},
        {"spectrum that falls back", material("\"diffuse\" \"spectrum reflectance\" [500 1 400 1]"), 65, "error: scene.pbrt:2:20: "},
        {"Fresnel's name wrong", material("\"conductor\" \"string fresnel\" \"shlick\""), 65,
         "error: scene.pbrt:2:1: material 'conductor': unknown fresnel 'shlick'; did you mean 'schlick'?"},
        {"exponent -1", material("\"phong\" \"float exponent\" -1"), 65, "error: scene.pbrt:2:1: material 'phong': exponent is -1"},
        {"exponent 1e30", material("\"blinn\" \"float exponent\" 1e30"), 65, "error: scene.pbrt:2:1: material 'blinn': exponent is 1"},
        {"radius 0", sphere("\"float radius\" 0"), 65, "error: scene.pbrt:2:16: radius is 0, outside the allowed range"},
        {"radius -1", sphere("\"float radius\" -1"), 65, "error: scene.pbrt:2:16: radius is -1, outside the allowed range"},
        {"radius NaN", sphere("\"float radius\" nan"), 65, "error: scene.pbrt:2:31: expected a number, found 'nan'"},
        {"unknown shape", world("Shape \"spere\""), 65, "error: scene.pbrt:2:1: unknown shape 'spere'; did you mean 'sphere'?"},
        {"mesh without points", world("Shape \"trianglemesh\""), 65, "error: scene.pbrt:2:1: shape 'trianglemesh': "},
        {"index beyond the points", world("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]"),
         65, "error: scene.pbrt:2:1: shape 'trianglemesh': \"indices\"[2] is 3, outside 0 to 2"},
        {"negative index", world("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 -1]"), 65,
         "error: scene.pbrt:2:1: shape 'trianglemesh': \"indices\"[2] is -1, outside 0 to 2"},
        {"sphere beyond what rays reach", world("Translate 1e30 0 0 Shape \"sphere\""), 0,
         "warning: scene.pbrt:2:20: shape 'sphere': it is too large or too small to be seen"},
    };
}

}  // namespace penumbra::bad_input
