// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/print/detail/MeshPiece.h>

#include <osgDB/WriteFile>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>
#include <utility>

namespace fs = std::filesystem;

namespace osgGeoFX
{

namespace
{

/// `first`: the numbers of the piece's first vertex, place and normal; 0 where it has none.
void putTriangles(std::ofstream& mesh, const std::vector<unsigned int>& corners,
                  const std::size_t (&first)[3])
{
    const auto [vertex, place, normal] = first;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        mesh << (i % 3 == 0 ? "f " : " ") << vertex + corners[i];
        if (place || normal) mesh << '/';
        if (place) mesh << place + corners[i];
        if (normal) mesh << '/' << normal + corners[i];
        if (i % 3 == 2) mesh << '\n';
    }
}

/// Takes those triangles out that stand upright to their normals: walls between tiles, which have the normals of the ground above them, and
/// what rounding leaves of slivers. Readers of files would turn them over, some here and some there.
std::vector<unsigned int> takeWalls(const MeshPiece& piece, std::vector<unsigned int>& corners)
{
    constexpr double upright = 0.05;
    std::vector<unsigned int> walls, others;
    for (std::size_t i = 0; i + 2 < corners.size() && !piece.normals.empty(); i += 3)
    {
        const unsigned int* const corner = &corners[i];
        osg::Vec3f at[3];
        osg::Vec3d normal;
        for (std::size_t j = 0; j < 3; ++j)
        {
            at[j] = osg::Vec3f(piece.positions[corner[j]]);
            normal += piece.normals[corner[j]];
        }
        const osg::Vec3d front = osg::Vec3d(at[1] - at[0]) ^ osg::Vec3d(at[2] - at[0]);
        const bool wall = !(front * normal > upright * front.length() * normal.length());
        std::vector<unsigned int>& kind = wall ? walls : others;
        kind.insert(kind.end(), corner, corner + 3);
    }
    if (!piece.normals.empty()) corners = std::move(others);
    return walls;
}

/// In these files y is up.
void putVertices(std::ofstream& mesh, const MeshPiece& piece)
{
    char line[160];
    for (const osg::Vec3d& each : piece.positions)
    {
        std::snprintf(line, sizeof(line), "v %.3f %.3f %.3f\n", each.x(), each.z(), -each.y());
        mesh << line;
    }
    for (const osg::Vec3d& each : piece.normals)
    {
        std::snprintf(line, sizeof(line), "vn %.4f %.4f %.4f\n", each.x(), each.z(), -each.y());
        mesh << line;
    }
    for (const osg::Vec2f& each : piece.places)
    {
        std::snprintf(line, sizeof(line), "vt %.6f %.6f\n", static_cast<double>(each.x()),
                      static_cast<double>(each.y()));
        mesh << line;
    }
}

} // namespace

bool writeObjFile(const std::string& file, const std::vector<MeshPiece>& pieces,
                  const std::vector<std::string>& notes)
{
    const fs::path whole(file);
    const fs::path materials = fs::path(whole).replace_extension(".mtl");
    const fs::path textures = fs::path(whole).replace_extension(".textures");
    std::error_code fault;
    fs::create_directories(textures, fault);
    std::ofstream mesh(whole), material(materials);
    for (const std::string& note : notes)
        mesh << "# " << note << '\n';
    mesh << "mtllib " << materials.filename().string() << '\n';
    std::map<const osg::Image*, std::string> names;
    std::size_t vertex = 1, place = 1, normal = 1, number = 0;
    for (const MeshPiece& piece : pieces)
    {
        const osg::Image* const image = piece.texture ? piece.texture->getImage() : nullptr;
        const auto [known, isNew] = names.try_emplace(image, "ground" + std::to_string(names.size()));
        if (isNew)
        {
            material << "newmtl " << known->second << "\nKa 1 1 1\nKd 1 1 1\nillum 1\n";
            const std::string name = known->second + ".png";
            if (image && osgDB::writeImageFile(*image, (textures / name).string()))
                material << "map_Kd " << (textures.filename() / name).generic_string() << '\n';
        }
        std::vector<unsigned int> corners = piece.corners;
        const std::vector<unsigned int> walls = takeWalls(piece, corners);
        const std::size_t firstPlace = piece.places.empty() ? 0 : place;
        mesh << "o piece" << ++number << "\nusemtl " << known->second << '\n';
        putVertices(mesh, piece);
        putTriangles(mesh, corners, {vertex, firstPlace, piece.normals.empty() ? 0 : normal});
        if (!walls.empty()) mesh << "o piece" << number << ".walls\nusemtl " << known->second << '\n';
        putTriangles(mesh, walls, {vertex, firstPlace, 0});
        vertex += piece.positions.size();
        place += piece.places.size();
        normal += piece.normals.size();
    }
    mesh.close();
    material.close();
    return mesh && material && !fault;
}

} // namespace osgGeoFX
