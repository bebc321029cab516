// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// GLB and 3MF files made by hand, so that the readers are tested against the formats and not against a library.
#pragma once

#include <cstdint>
#include <string>

#include "zip_bytes.h"

namespace eigencrust {

/// \param json of the first chunk \param binary of the second; empty: there is none
inline std::string glb_file(std::string json, std::string binary = {}) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const auto size = [](const std::string& bytes) { return static_cast<std::uint32_t>(bytes.size()); };
  std::string chunks = raw_bytes<std::uint32_t>({size(json), 0x4e4f534a}) + json;
  if (!binary.empty()) chunks += raw_bytes<std::uint32_t>({size(binary), 0x004e4942}) + binary;
  return "glTF" + raw_bytes<std::uint32_t>({2, size(chunks) + 12}) + chunks;
}

/// One triangle (0 0 0) (1 0 0) (0 1 0), indexed by bytes, below `nodes`; scene 0 shows node 0.
inline std::string glb_triangle(const std::string& nodes, const std::string& more = {}) {
  return glb_file(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
                      R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)" +
                      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)" +
                      R"({"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}],)" +
                      R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],)" +
                      R"("buffers":[{"byteLength":39}])" + more + "}",
                  raw_bytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + std::string("\0\1\2", 3));
}

/// \param model the XML without its first line
inline std::string three_mf_file(const std::string& model) {
  return zip_file({{"[Content_Types].xml", "<Types/>"},
                   {"_rels/.rels",
                    "<Relationships><Relationship Type='http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel' "
                    "Target='/3D/3dmodel.model'/></Relationships>"},
                   {"3D/3dmodel.model", "<?xml version='1.0'?>" + model}});
}

/// The mesh of the corner tetrahedron. \param triangle attributes of the first triangle
inline std::string three_mf_mesh(const std::string& triangle = {}) {
  return "<mesh><vertices><vertex x='0' y='0' z='0'/><vertex x='1' y='0' z='0'/><vertex x='0' y='1' z='0'/>"
         "<vertex x='0' y='0' z='1'/></vertices><triangles><triangle v1='0' v2='2' v3='1' " +
         triangle +
         "/><triangle v1='0' v2='1' v3='3'/><triangle v1='0' v2='3' v3='2'/><triangle v1='1' v2='2' v3='3'/>"
         "</triangles></mesh>";
}

} // namespace eigencrust
