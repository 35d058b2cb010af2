// The PLY reader: every format, type and layout gives the same mesh, and no file makes it do worse than throw Error.

#include "core/geometry/ply.h"

#include "core/base/error.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

namespace penumbra {
namespace {

// --- writing ---------------------------------------------------------------------------------------------------------

enum class Coding { Ascii, Little, Big };

/// Writes values of any PLY type in any coding, so that a test says its file once.
class PlyWriter {
public:
    explicit PlyWriter(Coding coding, const std::string& lineEnd = "\n") : coding_(coding), lineEnd_(lineEnd) {
        constexpr const char* kNames[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        line("ply").line(std::string("format ") + kNames[static_cast<int>(coding)] + " 1.0");
    }

    PlyWriter& line(const std::string& text) {
        text_ += text + lineEnd_;
        return *this;
    }
    PlyWriter& value(const std::string& type, double v) {
        if (coding_ == Coding::Ascii) {
            char digits[40];
            std::snprintf(digits, sizeof digits, "%.10g ", v);
            text_ += digits;
        } else if (type == "char" || type == "int8")
            append(static_cast<std::int8_t>(v));
        else if (type == "uchar" || type == "uint8")
            append(static_cast<std::uint8_t>(v));
        else if (type == "short" || type == "int16")
            append(static_cast<std::int16_t>(v));
        else if (type == "ushort" || type == "uint16")
            append(static_cast<std::uint16_t>(v));
        else if (type == "int" || type == "int32")
            append(static_cast<std::int32_t>(v));
        else if (type == "uint" || type == "uint32")
            append(static_cast<std::uint32_t>(v));
        else if (type == "float" || type == "float32")
            append(static_cast<float>(v));
        else
            append(v);
        return *this;
    }
    PlyWriter& values(const std::string& type, const std::vector<double>& list) {
        for (const double v : list)
            value(type, v);
        return *this;
    }
    PlyWriter& list(const std::string& countType, const std::string& type, const std::vector<double>& list) {
        return value(countType, static_cast<double>(list.size())).values(type, list);
    }
    PlyWriter& endOfEntry() {
        if (coding_ == Coding::Ascii) text_ += lineEnd_;
        return *this;
    }
    const std::string& text() const { return text_; }

private:
    template <class T>
    void append(T v) {
        char bytes[sizeof v];
        std::memcpy(bytes, &v, sizeof v);
        if (coding_ == Coding::Big) std::reverse(bytes, bytes + sizeof v);
        text_.append(bytes, sizeof v);
    }

    Coding coding_;
    std::string lineEnd_, text_;
};

constexpr Coding kCodings[] = {Coding::Ascii, Coding::Little, Coding::Big};

/// The header of `vertices` vertices x y z and `faces` faces, then nothing.
PlyWriter plainHeader(Coding coding, int vertices, int faces, const std::string& type = "float",
                      const std::string& listTypes = "uchar int", const std::string& lineEnd = "\n") {
    PlyWriter writer(coding, lineEnd);
    writer.line("element vertex " + std::to_string(vertices));
    for (const char* axis : {"x", "y", "z"})
        writer.line("property " + type + " " + axis);
    writer.line("element face " + std::to_string(faces)).line("property list " + listTypes + " vertex_indices");
    return writer.line("end_header");
}

const std::vector<double> kSquare = {0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0};

/// Two triangles that make a square.
std::string squareFile(Coding coding) {
    PlyWriter writer = plainHeader(coding, 4, 2);
    writer.values("float", kSquare).list("uchar", "int", {0, 1, 2}).list("uchar", "int", {0, 2, 3});
    return writer.text();
}

std::string compressed(const std::string& text) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&stream, text.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

// --- reading ---------------------------------------------------------------------------------------------------------

TriangleMesh meshOf(const std::string& file) {
    Warnings strict(true);
    return readPlyBytes(file, "m.ply", strict).mesh;
}

std::string errorOf(const std::string& file) {
    try {
        Warnings warnings;
        readPlyBytes(file, "m.ply", warnings);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadData);
        return error.what();
    }
    return "no error";
}

std::vector<std::string> warningsOf(const std::string& file) {
    Warnings warnings;
    readPlyBytes(file, "m.ply", warnings);
    return warnings.all();
}

void expectSquare(const TriangleMesh& mesh) {
    EXPECT_EQ(mesh.positions, std::vector<float>(kSquare.begin(), kSquare.end()));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_GE((mesh.positions.capacity() - mesh.positions.size()) * sizeof(float), 16u);
}

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << text

TEST(Ply, EveryCodingGivesTheSameMesh) {
    for (const Coding coding : kCodings)
        expectSquare(meshOf(squareFile(coding)));
}

TEST(Ply, EveryScalarType) {
    for (const Coding coding : kCodings)
        for (const std::string type : {"char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8",
                                       "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"}) {
            PlyWriter writer = plainHeader(coding, 4, 2, type, "uchar " + type);
            writer.values(type, kSquare).list("uchar", type, {0, 1, 2}).list("uchar", type, {0, 2, 3});
            expectSquare(meshOf(writer.text()));
        }
}

TEST(Ply, EveryIntegerTypeAsLengthOfLists) {
    for (const Coding coding : kCodings)
        for (const std::string type : {"char", "uchar", "short", "ushort", "int", "uint"}) {
            PlyWriter writer = plainHeader(coding, 4, 2, "float", type + " ushort");
            writer.values("float", kSquare).list(type, "ushort", {0, 1, 2}).list(type, "ushort", {0, 2, 3});
            expectSquare(meshOf(writer.text()));
        }
}

TEST(Ply, PropertiesInAnyOrderAmongUnknownOnes) {
    for (const Coding coding : kCodings) {
        PlyWriter writer(coding);
        writer.line("comment made by hand").line("obj_info nothing").line("element material 2");
        writer.line("property list ushort double weights").line("property uchar id");
        writer.line("element vertex 3").line("property uchar red").line("property float nz").line("property double t");
        writer.line("property float y").line("property list uchar short friends").line("property float x");
        writer.line("property double z").line("property float nx").line("property float ny").line("property float s");
        writer.line("element face 1").line("property list uchar float texcoord").line("property int face_indices");
        writer.line("property list uint uint vertex_index").line("property uchar flags");
        writer.line("element edge 1").line("property int from").line("property int to").line("end_header");
        writer.list("ushort", "double", {1, 2})
            .value("uchar", 3)
            .endOfEntry()
            .list("ushort", "double", {})
            .value("uchar", 4);
        for (int v = 0; v < 3; ++v) {
            writer.endOfEntry()
                .value("uchar", 200)
                .value("float", 30 + v)
                .value("double", 50 + v)
                .value("float", 10 + v);
            writer.list("uchar", "short", std::vector<double>(static_cast<std::size_t>(v), -1)).value("float", v);
            writer.value("double", 20 + v).value("float", 31 + v).value("float", 32 + v).value("float", 40 + v);
        }
        writer.endOfEntry().list("uchar", "float", {.1, .2, .3, .4, .5, .6, .7, .8}).value("int", -17);
        writer.list("uint", "uint", {2, 1, 0}).value("uchar", 255).endOfEntry().values("int", {0, 1});
        const TriangleMesh mesh = meshOf(writer.text());
        EXPECT_EQ(mesh.positions, (std::vector<float>{0, 10, 20, 1, 11, 21, 2, 12, 22}));
        EXPECT_EQ(mesh.normals, (std::vector<float>{31, 32, 30, 32, 33, 31, 33, 34, 32}));
        EXPECT_EQ(mesh.uvs, (std::vector<float>{40, 50, 41, 51, 42, 52}));
        EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{2, 1, 0}));
        EXPECT_EQ(mesh.faceIndices, (std::vector<std::int32_t>{-17}));
        EXPECT_TRUE(mesh.tangents.empty());
    }
}

/// One triangle whose vertices also have the given properties, of values 100, 101, ...
std::string withVertexProperties(const std::vector<std::string>& names) {
    PlyWriter writer(Coding::Ascii);
    writer.line("element vertex 3").line("property float x").line("property float y").line("property float z");
    for (const std::string& name : names)
        writer.line("property float " + name);
    writer.line("element face 1").line("property list uchar int vertex_indices").line("end_header");
    for (int v = 0; v < 3; ++v) {
        writer.values("float", {double(v), double(v * v), 0});
        for (std::size_t i = 0; i < names.size(); ++i)
            writer.value("float", 100 + static_cast<double>(i));
        writer.endOfEntry();
    }
    return writer.list("uchar", "int", {0, 1, 2}).text();
}

TEST(Ply, EverySpellingOfTextureCoordinates) {
    const std::vector<float> expected = {100, 101, 100, 101, 100, 101};
    for (const std::vector<std::string>& names : std::vector<std::vector<std::string>>{
             {"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}})
        EXPECT_EQ(meshOf(withVertexProperties(names)).uvs, expected) << names[0];
    EXPECT_EQ(meshOf(withVertexProperties({"s", "t", "u", "v"})).uvs[0], 102);
    EXPECT_TRUE(meshOf(withVertexProperties({"u", "t"})).uvs.empty());
}

TEST(Ply, HalfANormalIsNone) {
    const std::string file = withVertexProperties({"nx", "nz"});
    EXPECT_EQ(warningsOf(file),
              (std::vector<std::string>{"m.ply: vertices have only some of nx, ny, nz; the normals are ignored"}));
}

TEST(Ply, LinesMayEndInCarriageReturns) {
    for (const Coding coding : kCodings) {
        PlyWriter writer = plainHeader(coding, 4, 2, "float", "uchar int", "\r\n");
        writer.values("float", kSquare).endOfEntry();
        writer.list("uchar", "int", {0, 1, 2}).endOfEntry().list("uchar", "int", {0, 2, 3}).endOfEntry();
        expectSquare(meshOf(writer.text()));
    }
}

TEST(Ply, FacesMayComeBeforeVertices) {
    const std::string file =
        "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty float z\nend_header\n4 0 1 2 3\n"
        "0 0 0  2 0 0  2 1 0  0 1 0";
    expectSquare(meshOf(file));
}

TEST(Ply, QuadsAreCutWhereTheyAreConvex) {
    // A dart, concave at the corner (1, 1), in each of the four orders that start at another corner.
    const double points[4][2] = {{0, 0}, {4, 0}, {1, 1}, {0, 4}};
    for (int start = 0; start < 4; ++start) {
        PlyWriter writer = plainHeader(Coding::Little, 4, 1);
        for (int i = 0; i < 4; ++i)
            writer.values("float", {points[(start + i) % 4][0], points[(start + i) % 4][1], 0});
        const TriangleMesh mesh = meshOf(writer.list("uchar", "int", {0, 1, 2, 3}).text());
        ASSERT_EQ(mesh.triangleCount(), 2u);
        EXPECT_DOUBLE_EQ(totalArea(mesh), 4) << start;
        for (int t = 0; t < 2; ++t)
            EXPECT_GT(triangleNormal(mesh, mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]).z, 0);
    }
}

TEST(Ply, PolygonsMixAndOthersAreCounted) {
    for (const Coding coding : kCodings) {
        PlyWriter writer(coding);
        writer.line("element vertex 4").line("property float x").line("property float y").line("property float z");
        writer.line("element face 7").line("property list uchar int vertex_indices").line("property int face_indices");
        writer.line("end_header").values("float", kSquare);
        const std::vector<std::vector<double>> faces = {{},     {0, 1, 2},       {0},      {0, 1, 2, 3},
                                                        {0, 1}, {0, 1, 2, 3, 0}, {3, 2, 1}};
        for (std::size_t f = 0; f < faces.size(); ++f)
            writer.list("uchar", "int", faces[f]).value("int", static_cast<double>(f)).endOfEntry();
        Warnings warnings;
        const TriangleMesh mesh = readPlyBytes(writer.text(), "m.ply", warnings).mesh;
        EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2, 0, 2, 3, 3, 2, 1}));
        EXPECT_EQ(mesh.faceIndices, (std::vector<std::int32_t>{1, 3, 3, 6}));
        EXPECT_EQ(warnings.all(),
                  (std::vector<std::string>{"m.ply: 4 polygons of neither 3 nor 4 corners are skipped"}));
    }
}

TEST(Ply, NumbersOfTextsInEveryForm) {
    PlyWriter writer = plainHeader(Coding::Ascii, 4, 1);
    const TriangleMesh mesh =
        meshOf(writer.text() + "+1.5 -.25\t1e2\r\n\n NAN inf -INF\v1e400 -1E+999 1e-400 1e-300 1e300 -1e39\n3 0 1 2");
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(mesh.positions[0], 1.5f);
    EXPECT_EQ(mesh.positions[1], -.25f);
    EXPECT_EQ(mesh.positions[2], 100.f);
    EXPECT_TRUE(std::isnan(mesh.positions[3]));
    EXPECT_EQ((std::vector<float>(mesh.positions.begin() + 4, mesh.positions.end())),
              (std::vector<float>{infinity, -infinity, infinity, -infinity, 0, 0, infinity, -infinity}));
}

TEST(Ply, NumbersThatAreNotFiniteAreKept) {
    for (const Coding coding : kCodings) {
        PlyWriter writer = plainHeader(coding, 4, 2, "double");
        writer.values("double", {std::nan(""), HUGE_VAL, 1e300, 0, 0, 0, 1, 0, 0, 0, 1, 0});
        TriangleMesh mesh = meshOf(writer.list("uchar", "int", {0, 1, 2}).list("uchar", "int", {1, 2, 3}).text());
        EXPECT_EQ(mesh.triangleCount(), 2u);
        EXPECT_EQ(dropBadTriangles(mesh), 1u);
    }
}

TEST(Ply, MeshesLargerThanTheBlockOfTheReader) {
    for (const Coding coding : kCodings) {
        constexpr int kVertices = 20000;
        PlyWriter writer = plainHeader(coding, kVertices, kVertices - 2, "float", "uchar ushort");
        for (int v = 0; v < kVertices; ++v)
            writer.values("float", {double(v), 2.0 * v, -double(v)});
        for (int v = 0; v + 2 < kVertices; ++v)
            writer.list("uchar", "ushort", {double(v), v + 1.0, v + 2.0});
        for (const std::string& file : {writer.text(), compressed(writer.text())}) {
            const TriangleMesh mesh = meshOf(file);
            ASSERT_EQ(mesh.vertexCount(), std::size_t{kVertices});
            ASSERT_EQ(mesh.triangleCount(), std::size_t{kVertices - 2});
            for (std::uint32_t v = 0; v < kVertices; ++v)
                ASSERT_EQ(mesh.positions[3 * v + 1], 2.f * static_cast<float>(v));
            for (std::uint32_t t = 0; t + 2 < kVertices; ++t)
                ASSERT_EQ(mesh.indices[3 * t + 2], t + 2);
        }
    }
}

TEST(Ply, SkippedListsLargerThanTheBlockOfTheReader) {
    for (const Coding coding : kCodings) {
        PlyWriter writer = plainHeader(coding, 4, 3, "float", "uint uint");
        writer.values("float", kSquare).list("uint", "uint", {0, 1, 2});
        writer.list("uint", "uint", std::vector<double>(100000, 9e8)).list("uint", "uint", {0, 2, 3});
        Warnings warnings;
        expectSquare(readPlyBytes(writer.text(), "m.ply", warnings).mesh);
    }
}

// --- files -----------------------------------------------------------------------------------------------------------

class PlyFile : public ::testing::Test {
protected:
    void SetUp() override {
        std::string pattern = (std::filesystem::temp_directory_path() / "penumbra-ply-XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return (folder_ / name).string();
    }

    std::filesystem::path folder_;
};

TEST_F(PlyFile, GzipIsKnownByItsFirstBytes) {
    Warnings strict(true);
    for (const Coding coding : kCodings) {
        expectSquare(readPly(write("plain.ply", squareFile(coding)), strict).mesh);
        expectSquare(readPly(write("packed.ply.gz", compressed(squareFile(coding))), strict).mesh);
        expectSquare(readPly(write("packed.ply", compressed(squareFile(coding))), strict).mesh);
        expectSquare(readPly(write("plain.ply.gz", squareFile(coding)), strict).mesh);
    }
}

TEST_F(PlyFile, WhatCannotBeOpenedIsMissingInput) {
    Warnings warnings;
    for (const std::string& path :
         {(folder_ / "absent.ply").string(), folder_.string(), std::string("/dev/zero"), std::string()}) {
        try {
            readPly(path, warnings);
            ADD_FAILURE() << path;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::MissingInput);
            EXPECT_CONTAINS(std::string(error.what()), path);
        }
    }
}

// --- hostile files ---------------------------------------------------------------------------------------------------

TEST(PlyHostile, HeadersNameTheirLine) {
    const std::string vertex = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string start = "ply\nformat ascii 1.0\n";
    EXPECT_EQ(errorOf(""), "m.ply:1: not a PLY file: its first line is not 'ply'");
    EXPECT_EQ(errorOf("ply"), "m.ply:1: not a PLY file: its first line is not 'ply'");
    EXPECT_EQ(errorOf("solid\nfacet\n"), "m.ply:1: not a PLY file: its first line is not 'ply'");
    EXPECT_EQ(errorOf("ply\n"), "m.ply:2: the file ends before 'end_header'");
    EXPECT_EQ(errorOf(start + vertex), "m.ply:7: the file ends before 'end_header'");
    EXPECT_EQ(errorOf("ply\nend_header\n"), "m.ply:2: the header has no 'format' line");
    EXPECT_EQ(errorOf(start + "format ascii 1.0\n"), "m.ply:3: a second 'format' line");
    EXPECT_CONTAINS(errorOf("ply\nformat binary 1.0\n"), "m.ply:2: unknown format 'binary'; known: ascii");
    EXPECT_CONTAINS(errorOf("ply\nformat ascii 2.0\n"), "m.ply:2: unknown version '2.0'");
    EXPECT_CONTAINS(errorOf("ply\nformat ascii\n"), "m.ply:2: expected 'format'");
    EXPECT_CONTAINS(errorOf(start + "elemnt vertex 1\n"), "m.ply:3: unknown word 'elemnt'");
    EXPECT_CONTAINS(errorOf(start + "element vertex\n"), "m.ply:3: expected 'element'");
    EXPECT_CONTAINS(errorOf(start + "property float x\n"), "m.ply:3: a property before the first element");
    EXPECT_CONTAINS(errorOf(start + vertex + vertex), "m.ply:7: a second element 'vertex'");
    EXPECT_CONTAINS(errorOf(start + vertex + "property float x\n"), "m.ply:7: a second property 'x'");
    EXPECT_CONTAINS(errorOf(start + vertex + "property flaot w\n"),
                    "m.ply:7: unknown type 'flaot'; did you mean 'float'?");
    EXPECT_CONTAINS(errorOf(start + vertex + "property list uchar int\n"), "m.ply:7: expected 'property TYPE NAME'");
    EXPECT_CONTAINS(errorOf(start + vertex + "property list float int n\n"),
                    "m.ply:7: the length of a list cannot be of type 'float'");
    EXPECT_CONTAINS(errorOf(start + "comment a\n\x01\xff\n"), "m.ply:4: unknown word");
}

TEST(PlyHostile, CountsAreCheckedAgainstTheFile) {
    for (const std::string count : {"-1", "1e3", "", "x", "0x10", "18446744073709551616", "1.0"})
        EXPECT_CONTAINS(errorOf("ply\nformat ascii 1.0\nelement vertex " + count + "\n"), "m.ply:3: ") << count;
    for (const std::string coding : {"ascii", "binary_little_endian", "binary_big_endian"})
        for (const std::string count :
             {"100", "2147483648", "4294967297", "18446744073709551615", "6148914691236517206"})
            for (const bool ofFaces : {false, true}) {
                const std::string file =
                    "ply\nformat " + coding + " 1.0\nelement vertex " + (ofFaces ? "0" : count) +
                    "\nproperty float x\nproperty float y\nproperty float z\nelement face " + (ofFaces ? count : "0") +
                    "\nproperty list uchar int vertex_indices\nend_header\n" + "0 0 0 3 0 0 0 0 0 0 0 0 0 0 0 0";
                EXPECT_CONTAINS(errorOf(file), "m.ply:9: element '");
                EXPECT_CONTAINS(errorOf(file), "more than the file holds");
                if (count == "100") continue;  // which a gzip file of this size might well hold
                EXPECT_CONTAINS(errorOf(compressed(file)), "more than the file holds");
            }
}

TEST(PlyHostile, EntriesWithoutPropertiesTakeNoTime) {
    std::string file = squareFile(Coding::Little);
    file.insert(file.find("end_header"), "element nothing 18446744073709551615\n");
    expectSquare(meshOf(file));
}

TEST(PlyHostile, LongHeadersAreRefused) {
    const std::string start = "ply\nformat ascii 1.0\n";
    EXPECT_EQ(errorOf(start + "comment " + std::string(10 << 20, 'x') + "\n"),
              "m.ply:3: no 'end_header' within the first 64 KB");
    std::string lines = start;
    while (lines.size() < (1 << 20))
        lines += "comment\n";
    EXPECT_CONTAINS(errorOf(lines), "no 'end_header' within the first 64 KB");
    EXPECT_CONTAINS(errorOf(start + std::string(30000, 'x') + " 1\n"), "unknown word");
}

TEST(PlyHostile, NeededElementsAndPropertiesAreNamed) {
    EXPECT_EQ(errorOf("ply\nformat ascii 1.0\nend_header\n"), "m.ply: has no element 'vertex'");
    EXPECT_EQ(errorOf("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n"), "m.ply: has no element 'face'");
    EXPECT_EQ(errorOf("ply\nformat ascii 1.0\nelement vertex 0\nelement face 0\nend_header\n"),
              "m.ply: element 'vertex' lacks x, y or z");
    const std::string vertex =
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n";
    EXPECT_EQ(errorOf(vertex + "element face 0\nproperty int vertex_indices\nend_header\n"),
              "m.ply: element 'face' has no list 'vertex_indices'");
    std::string list = vertex;
    list.replace(list.find("float z"), 7, "list uchar float z");
    EXPECT_EQ(errorOf(list + "element face 0\nend_header\n"), "m.ply: element 'vertex' lacks x, y or z");
}

TEST(PlyHostile, NamesOfElementsAreShownSafely) {
    const std::string text = "ply\nformat ascii 1.0\nelement mat\x01 1\nproperty list uchar float w\nelement vertex 1\n"
                             "property float x\nproperty float y\nproperty float z\nelement face 0\n"
                             "property list uchar int vertex_indices\nend_header\nfoo bar\n0 0 0\n";
    EXPECT_CONTAINS(errorOf(text), "m.ply: 'mat\\x01' ");
}

TEST(PlyHostile, IndicesAreChecked) {
    for (const Coding coding : kCodings) {
        const auto fileWith = [&](const std::string& type, double index) {
            PlyWriter writer = plainHeader(coding, 4, 2, "float", "uchar " + type);
            writer.values("float", kSquare).list("uchar", type, {0, 1, 2}).list("uchar", type, {0, index, 3});
            return writer.text();
        };
        EXPECT_EQ(errorOf(fileWith("int", 4)), "m.ply: face 1 of 2: there is no vertex 4, only 0 to 4 - 1");
        EXPECT_EQ(errorOf(fileWith("int", -1)), "m.ply: face 1 of 2: there is no vertex -1, only 0 to 4 - 1");
        EXPECT_CONTAINS(errorOf(fileWith("uint", 2147483648.0)), "face 1 of 2: there is no vertex 2147483648");
        EXPECT_CONTAINS(errorOf(fileWith("uint", 4294967295.0)), "face 1 of 2: there is no vertex 4294967295");
        EXPECT_CONTAINS(errorOf(fileWith("double", std::nan(""))), "face 1 of 2: there is no vertex ");
        EXPECT_CONTAINS(errorOf(fileWith("float", 1.5)), "face 1 of 2: there is no vertex 1.5");
        EXPECT_CONTAINS(errorOf(fileWith("double", 1e300)), "face 1 of 2: there is no vertex 1e+300");
    }
}

TEST(PlyHostile, LengthsOfListsAreChecked) {
    for (const Coding coding : kCodings) {
        PlyWriter negative = plainHeader(coding, 4, 2, "float", "char int");
        negative.values("float", kSquare).value("char", -1).values("int", {0, 1, 2, 3, 4, 5});
        EXPECT_EQ(errorOf(negative.text()), "m.ply: face 0 of 2: a list cannot have the length -1");
        PlyWriter huge = plainHeader(coding, 4, 2, "float", "uint int");
        huge.values("float", kSquare).value("uint", 4294967295.0).values("int", {0, 1, 2, 3, 4, 5});
        EXPECT_EQ(errorOf(huge.text()), "m.ply: face 0 of 2: the file ends within it");
        PlyWriter garbage = plainHeader(coding, 4, 2);
        garbage.values("float", kSquare).value("uchar", 255).values("int", std::vector<double>(254, -7));
        EXPECT_EQ(errorOf(garbage.text()), "m.ply: face 0 of 2: the file ends within it");
    }
    const std::string head = plainHeader(Coding::Ascii, 4, 1).text() + "0 0 0 2 0 0 2 1 0 0 1 0\n";
    EXPECT_CONTAINS(errorOf(head + "3.5 0 1 2"), "face 0 of 1: a list cannot have the length 3.5");
    EXPECT_CONTAINS(errorOf(head + "1e10 0 1 2"), "face 0 of 1: a list cannot have the length 1e+10");
    EXPECT_CONTAINS(errorOf(head + "nan 0 1 2"), "face 0 of 1: a list cannot have the length nan");
}

TEST(PlyHostile, WordsThatAreNoNumbersAreShown) {
    const std::string head = plainHeader(Coding::Ascii, 3, 1).text();
    for (const std::string word : {"zero", "1,5", "0x10", "--1", "+-1", "+", "1e", "1.0f", "nanny"})
        EXPECT_EQ(errorOf(head + "0 0 0 0 " + word + " 0 0 0 0 3 0 1 2"),
                  "m.ply: vertex 1 of 3: expected a number, found '" + word + "'");
    EXPECT_CONTAINS(errorOf(head + std::string(1 << 20, '1')),
                    "vertex 0 of 3: expected a number, found more than 256 letters");
    EXPECT_CONTAINS(errorOf(head + std::string(1 << 20, ' ')), "vertex 0 of 3: the file ends within it");
}

TEST(PlyHostile, EveryTruncationIsNoticed) {
    for (const Coding coding : kCodings) {
        const std::string whole = squareFile(coding);
        const std::string packed = compressed(whole);
        const std::size_t last = whole.find_last_not_of(' ');  // a text does not miss its last blank
        for (std::size_t size = 0; size < last; ++size)
            EXPECT_NE(errorOf(whole.substr(0, size)), "no error") << size;
        for (std::size_t size = 0; size < packed.size(); ++size)
            EXPECT_NE(errorOf(packed.substr(0, size)), "no error") << size;
    }
}

TEST(PlyHostile, MoreDataThanPromisedIsAWarning) {
    const std::vector<std::string> expected = {"m.ply: has more data than its header says; the rest is ignored"};
    for (const Coding coding : kCodings)
        EXPECT_EQ(warningsOf(squareFile(coding) + "1"), expected);
    EXPECT_TRUE(warningsOf(squareFile(Coding::Ascii) + " \r\n\n").empty());
}

TEST(PlyHostile, NoTrianglesIsAWarning) {
    for (const Coding coding : kCodings) {
        const std::vector<std::string> expected = {"m.ply: has no triangles"};
        EXPECT_EQ(warningsOf(plainHeader(coding, 0, 0).text()), expected);
    }
}

TEST(PlyHostile, DamagedGzipIsAnError) {
    std::string packed = compressed(squareFile(Coding::Little));
    EXPECT_EQ(errorOf(packed.substr(0, 2)), "m.ply: the gzip data end too early");
    EXPECT_CONTAINS(errorOf(packed + "more"), "m.ply: the gzip data are damaged");
    std::string flipped = packed;
    flipped[packed.size() - 6] ^= 1;  // the checksum
    EXPECT_CONTAINS(errorOf(flipped), "m.ply: the gzip data are damaged");
    flipped = packed;
    flipped[2] = 0;  // the method
    EXPECT_CONTAINS(errorOf(flipped), "m.ply: the gzip data are damaged");
}

TEST(PlyHostile, GzipOfSeveralMembersIsOneStream) {
    const std::string file = squareFile(Coding::Big);
    expectSquare(meshOf(compressed(file.substr(0, 50)) + compressed("") + compressed(file.substr(50))));
}

TEST(PlyHostile, GzipBombsAreLimited) {
    std::string bomb = plainHeader(Coding::Little, 4, 100).text();
    bomb.resize(80 << 20);  // zeros: vertices, then empty polygons, then more data than promised
    EXPECT_CONTAINS(warningsOf(compressed(bomb)).at(1), "100 polygons");
    std::string claimed = plainHeader(Coding::Little, 4, 79 << 20).text();
    claimed.resize(80 << 20);
    EXPECT_NE(errorOf(compressed(claimed)), "no error");
    std::string skipped =
        "ply\nformat binary_little_endian 1.0\nelement x 1\nproperty list uint uchar n\nelement vertex 0\n"
        "property float x\nproperty float y\nproperty float z\nelement face 0\n"
        "property list uchar int vertex_indices\nend_header\nfoo bar\n0 0 0\n";
    skipped += std::string("\xff\xff\xff\x7f", 4);
    skipped.resize(80 << 20);
    EXPECT_CONTAINS(errorOf(compressed(skipped)), "inflates to more than 64 MiB plus 100 times");
}

/// Files with a few bytes changed, cut or repeated are read or refused, no more; sanitizers watch.
TEST(PlyHostile, MutantsAreReadOrRefused) {
    std::mt19937 random(11);
    std::vector<std::string> seeds = {withVertexProperties({"nx", "ny", "nz", "u", "v"})};
    for (const Coding coding : kCodings) {
        seeds.push_back(squareFile(coding));
        seeds.push_back(compressed(squareFile(coding)));
    }
    int refused = 0;
    constexpr int kMutants = 20000;
    for (int i = 0; i < kMutants; ++i) {
        std::string file = seeds[random() % seeds.size()];
        for (unsigned edits = 1 + random() % 4; edits > 0 && !file.empty(); --edits) {
            const std::size_t at = random() % file.size();
            switch (random() % 4) {
                case 0:
                    file[at] = static_cast<char>(random());
                    break;
                case 1:
                    file[at] = "0123456789 \n"[random() % 12];
                    break;
                case 2:
                    file.erase(at, 1 + random() % 8);
                    break;
                default:
                    file.insert(at, file.substr(random() % file.size(), random() % 16));
                    break;
            }
        }
        try {
            Warnings warnings;
            TriangleMesh mesh = readPlyBytes(file, "m.ply", warnings).mesh;
            for (const std::uint32_t index : mesh.indices)
                ASSERT_LT(index, mesh.vertexCount());
            dropBadTriangles(mesh);
        } catch (const Error& error) {
            ASSERT_EQ(error.kind(), ErrorKind::BadData);
            ++refused;
        }
    }
    EXPECT_GT(refused, kMutants / 10);
    EXPECT_LT(refused, kMutants);
}

}  // namespace
}  // namespace penumbra
