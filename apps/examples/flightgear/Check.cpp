#include "Check.h"
namespace flightgear
{
int check(const osgGeoFX::Scene&, const osgGeoFX::ViewPoint&, int, const osgGeoFX::SceneRenderer::Options&)
{
    return 0;
}
}
