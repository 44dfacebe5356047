// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/print/detail/MeshPiece.h>

#include <osgDB/WriteFile>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>

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
        mesh << "o piece" << number++ << "\nusemtl " << known->second << '\n';
        putVertices(mesh, piece);
        putTriangles(mesh, piece.corners,
                     {vertex, piece.places.empty() ? 0 : place, piece.normals.empty() ? 0 : normal});
        vertex += piece.positions.size();
        place += piece.places.size();
        normal += piece.normals.size();
    }
    mesh.close();
    material.close();
    return mesh && material && !fault;
}

} // namespace osgGeoFX
