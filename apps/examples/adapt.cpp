// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program whose terrain has shaders that know nothing of the kit, and the line that bends them: adapt FILE
#include <osg/Program>
#include <osgDB/ReadFile>
#include <osgGA/TerrainManipulator>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/ProgramAdapter.h>
#include <osgViewer/Viewer>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!terrain) return 1;
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX,
                                       "#version 120\nvoid main() { gl_TexCoord[0] = gl_MultiTexCoord0; "
                                       "gl_Position = ftransform(); }\n"));
    program->addShader(
        new osg::Shader(osg::Shader::FRAGMENT,
                        "#version 120\nuniform sampler2D picture;\nvoid main() { vec4 color = "
                        "texture2D(picture, gl_TexCoord[0].xy); gl_FragColor = vec4(color.ggg, 1.0); }\n"));
    terrain->getOrCreateStateSet()->setAttribute(program, osg::StateAttribute::OVERRIDE);

    osgGeoFX::EffectScene::adapt(*program); // this one, wherever it is drawn
    osgGeoFX::ProgramAdapter adapter;       // or all that there are below a node,
    terrain->accept(adapter);
    const osg::ref_ptr<osgGeoFX::TileProgramAdapter> tiles = new osgGeoFX::TileProgramAdapter;
    osgGeoFX::TileGuard::install(terrain)->addListener(tiles); // and those that a pager brings

    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(new osgGeoFX::BirdsEyeView);
    scene->addChild(terrain);
    osgViewer::Viewer viewer;
    viewer.setSceneData(scene);
    viewer.setCameraManipulator(new osgGA::TerrainManipulator);
    return viewer.run();
}
