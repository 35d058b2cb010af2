// Bad PLY files, each the mesh of a small scene. The comments of tests/core_geometry_ply_test.cpp apply: here it is the
// program that is tested, there it is the reader alone.
#pragma once

#include "tests/bad_input/bad_input.h"

namespace penumbra::bad_input {

/// A scene whose only shape is the mesh m.ply of these bytes.
inline Files ply(Content bytes) {
    return world("Shape \"plymesh\" \"string filename\" \"m.ply\"", {{"m.ply", std::move(bytes)}});
}

/// The header of a mesh with x y z; the counts may be anything.
inline std::string plyHeader(const std::string& vertices, const std::string& faces, const std::string& format = "ascii",
                             const std::string& type = "float", const std::string& lineEnd = "\n") {
    std::string text;
    for (const std::string& line :
         {std::string("ply"), "format " + format + " 1.0", "element vertex " + vertices, "property " + type + " x",
          "property " + type + " y", "property " + type + " z", "element face " + faces,
          std::string("property list uchar int vertex_indices"), std::string("end_header")})
        text += line + lineEnd;
    return text;
}

/// One triangle in a text; `faces` are the lines of the faces.
inline std::string triangle(const std::string& faces, const std::string& count = "1") {
    return plyHeader("3", count) + "0 0 0\n1 0 0\n0 1 0\n" + faces;
}

/// One triangle in binary: three corners (0 0 0, 1 0 0, 0 1 0) and the face 0 1 2.
inline std::string binaryTriangle(bool bigEndian = false, const std::string& lineEnd = "\n") {
    const std::string one = bigEndian ? std::string("\x3f\x80\0\0", 4) : std::string("\0\0\x80\x3f", 4);
    const std::string zero(4, '\0');
    const auto index = [&](char i) {
        std::string bytes = zero;
        bytes[bigEndian ? 3 : 0] = i;
        return bytes;
    };
    return plyHeader("3", "1", bigEndian ? "binary_big_endian" : "binary_little_endian", "float", lineEnd) +
           repeated(zero, 3) + one + repeated(zero, 3) + one + zero + "\3" + index(0) + index(1) + index(2);
}

inline const std::string kMesh = "scene.pbrt:2:1: shape 'plymesh': m.ply";

inline std::vector<Case> plyHeaderCases() {
    const std::string error = "error: " + kMesh;
    return {
        {"empty", ply(""), 65, error + ":1: not a PLY file"},
        {"one word", ply("ply"), 65, error + ":1: not a PLY file"},
        {"one line", ply("ply\n"), 65, error + ":2: the file ends before 'end_header'"},
        {"another format", ply("solid cube\n"), 65, error + ":1: not a PLY file"},
        {"header without end", ply("ply\nformat ascii 1.0\nelement vertex 3\n"), 65, error + ":4: the file ends before 'end_header'"},
        {"header of a MB without end", ply([] { return "ply\nformat ascii 1.0\n" + repeated("comment a\n", 100000); }), 65,
         error + ":6554: no 'end_header' within the first 64 KB"},
        {"comment of a MB", ply([] { return "ply\ncomment " + std::string(1 << 20, 'c') + "\n"; }), 65,
         error + ":2: no 'end_header' within the first 64 KB"},
        {"obj_info of a MB", ply([] { return "ply\nobj_info " + std::string(1 << 20, 'c') + "\n"; }), 65,
         error + ":2: no 'end_header' within the first 64 KB"},
        {"no format", ply("ply\nelement vertex 0\nend_header\n"), 65, error + ":3: the header has no 'format' line"},
        {"unknown format", ply("ply\nformat binary 1.0\nend_header\n"), 65, error + ":2: unknown format 'binary'"},
        {"2^31 vertices", ply(plyHeader("2147483648", "1") + "0 0 0"), 65, error + ":9: element 'vertex' has 2147483648"},
        {"2^32 + 1 vertices", ply(plyHeader("4294967297", "1")), 65, error + ":9: element 'vertex' has 4294967297"},
        {"-1 vertices", ply(plyHeader("-1", "1")), 65, error + ":3: bad count '-1' of element 'vertex'"},
        {"1e3 vertices", ply(plyHeader("1e3", "1")), 65, error + ":3: bad count '1e3' of element 'vertex'"},
        {"2^64 vertices", ply(plyHeader("18446744073709551616", "1")), 65, error + ":3: bad count '18446744073709551616'"},
        {"2^31 faces", ply(plyHeader("3", "2147483648") + "0 0 0\n1 0 0\n0 1 0\n"), 65, error + ":9: element 'face' has 2147483648"},
        {"2^32 + 1 faces", ply(plyHeader("3", "4294967297")), 65, error + ":9: element 'vertex' has 3 entries"},
        {"-1 faces", ply(plyHeader("3", "-1")), 65, error + ":7: bad count '-1' of element 'face'"},
        {"1e3 faces", ply(plyHeader("3", "1e3")), 65, error + ":7: bad count '1e3' of element 'face'"},
        {"length of lists is a float",
         ply("ply\nformat ascii 1.0\nelement vertex 0\nelement face 0\nproperty list float int vertex_indices\nend_header\n"),
         65, error + ":5: the length of a list cannot be of type 'float'"},
        {"no coordinates",
         ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty float a\nelement face 0\n"
             "property list uchar int vertex_indices\nend_header\n0\n"),
         65, error + ": element 'vertex' lacks x, y or z"},
        {"no vertices at all", ply("ply\nformat ascii 1.0\nelement face 0\nend_header\n"), 65, error + ": has no element 'vertex'"},
        {"no faces at all", ply("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n"), 65,
         error + ": has no element 'face'"},
        {"header ends in CR LF, data binary", ply(binaryTriangle(false, "\r\n")), 0, ""},
        {"big-endian", ply(binaryTriangle(true)), 0, ""},
    };
}

inline std::vector<Case> plyDataCases() {
    const std::string error = "error: " + kMesh + ": ", warning = "warning: m.ply: ";
    const auto cut = [](std::size_t bytes) {
        std::string text = binaryTriangle();
        return text.substr(0, text.size() - bytes);
    };
    const std::string noTriangle = "warning: scene.pbrt:2:1: shape 'plymesh': no triangle is left of the mesh";
    return {
        {"index = number of vertices", ply(triangle("3 0 1 3")), 65, error + "face 0 of 1: there is no vertex 3"},
        {"index -1", ply(triangle("3 0 1 -1")), 65, error + "face 0 of 1: there is no vertex -1"},
        {"index 2^31", ply(triangle("3 0 1 2147483648")), 65, error + "face 0 of 1: there is no vertex 2147483648"},
        {"index 2^32 - 1", ply(triangle("3 0 1 4294967295")), 65, error + "face 0 of 1: there is no vertex 4294967295"},
        {"index nan", ply(triangle("3 0 1 nan")), 65, error + "face 0 of 1: there is no vertex nan"},
        {"index with a point", ply(triangle("3 0 1 1.5")), 65, error + "face 0 of 1: there is no vertex 1.5"},
        {"cut in the vertices", ply(cut(30)), 65, "error: " + kMesh + ":9: element 'vertex' has"},
        {"cut in the faces", ply(cut(8)), 65, error + "face 0 of 1: the file ends within it"},
        {"cut in the last byte", ply(cut(1)), 65, error + "face 0 of 1: the file ends within it"},
        {"more than the header says", ply(binaryTriangle() + "more"), 0, warning + "has more data than its header says"},
        {"more than the header says, strict", ply(binaryTriangle() + "more"), 65, error + "has more data", {"--strict"}},
        {"word for a number", ply(plyHeader("3", "1") + "0 0 zero 1 0 0 0 1 0 3 0 1 2"), 65,
         error + "vertex 0 of 3: expected a number, found 'zero'"},
        {"vertex nan", ply(plyHeader("3", "1") + "0 0 nan 1 0 0 0 1 0 3 0 1 2"), 0, noTriangle},
        {"vertex inf", ply(plyHeader("3", "1") + "0 0 inf 1 0 0 0 1 0 3 0 1 2"), 0, noTriangle},
        {"coordinates 1e300", ply(plyHeader("3", "1", "ascii", "double") + "0 0 1e300 1 0 0 0 1 0 3 0 1 2"), 0, noTriangle},
        {"faces of 0, 1 and 2 corners", ply(triangle("0\n1 0\n2 0 1\n3 0 1 2\n", "4")), 0,
         warning + "3 polygons of neither 3 nor 4 corners are skipped"},
        {"face of 200 corners", ply(triangle("200" + repeated(" 1", 200) + "\n3 0 1 2\n", "2")), 0,
         warning + "1 polygons of neither 3 nor 4 corners are skipped"},
        {"nothing but degenerate triangles", ply(triangle("3 0 0 0")), 0, noTriangle},
        {"no triangles", ply(plyHeader("3", "0") + "0 0 0 1 0 0 0 1 0"), 0, warning + "has no triangles"},
        {"some of the normal",
         ply("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
             "property float nx\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
             "0 0 0 0 1 0 0 0 0 1 0 0 3 0 1 2"),
         0, warning + "vertices have only some of nx, ny, nz"},
        {"list of uv longer than the corners",
         ply("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
             "0 0 0 1 0 0 0 1 0 3 0 1 2 9 1 2 3 4 5 6 7 8 9"),
         0, ""},
        {"damaged gzip", ply(std::string("\x1f\x8b\x08\x00\x00", 5)), 65, error + "the gzip data end too early"},
    };
}

}  // namespace penumbra::bad_input
