// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An engine that assembles its shaders itself, has a node of its own for its terrain, and culls for itself; and the lines that bend
// it: engine FILE
#include <osg/Program>
#include <osgDB/ReadFile>
#include <osgGA/TerrainManipulator>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/scene/EffectCullCallback.h>
#include <osgViewer/Viewer>

namespace
{

/// What the engine has: pieces of text, which it joins to a program.
class Shaders : public osgGeoFX::ShaderHost
{
public:
    explicit Shaders(osg::StateSet& terrain) : _terrain(&terrain) {}
    void use(const osgGeoFX::ShaderTexts& texts) override
    {
        const std::string version = "#version 330 compatibility\n";
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(osg::Shader::VERTEX,
                                           version + texts.vertex +
                                               "void main()\n{\n    gl_TexCoord[0] = gl_MultiTexCoord0;\n"
                                               "    gl_Position = gl_ProjectionMatrix * "
                                               "geofx_vertex(gl_ModelViewMatrix * gl_Vertex);\n}\n"));
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                           version + texts.fragment +
                                               "uniform sampler2D picture;\nvoid main()\n{\n    vec4 lit = "
                                               "texture(picture, gl_TexCoord[0].xy);\n"
                                               "    gl_FragColor = geofx_fragment(lit, vec4(0.0));\n}\n"));
        _terrain->setAttribute(program, osg::StateAttribute::OVERRIDE);
        _program = program;
    }
    bool draws(const osg::StateAttribute& program) const override { return &program == _program.get(); }

private:
    const osg::ref_ptr<osg::StateSet> _terrain;
    osg::ref_ptr<osg::Program> _program;
};

} // namespace

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> file = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!file) return 1;
    const osg::ref_ptr<osg::Group> terrain = new osg::Group; // of the engine's own class
    terrain->addChild(file);

    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(new osgGeoFX::BirdsEyeView);
    scene->setShaderHost(new Shaders(*file->getOrCreateStateSet()));
    scene->setEngineCulling(osgGeoFX::EffectScene::PROXY);
    terrain->setCullingActive(false);
    terrain->addCullCallback(new osgGeoFX::EffectCullCallback(scene));

    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded); // the engine changes its state in a cull
    viewer.setSceneData(terrain);
    viewer.setCameraManipulator(new osgGA::TerrainManipulator);
    return viewer.run();
}
