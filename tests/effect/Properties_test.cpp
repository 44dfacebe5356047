// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Every property of every class, from the classes' own tables: a new class or property is in these tests by itself,
// but for typed setters (TypedSetters.h), whose test says which one it misses. What files do with properties:
// Serializers_test.cpp.
#include <effect/TypedSetters.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <tools/NotifyWatch.h>
#include <tools/PropertySamples.h>
#include <tools/RandomSamples.h>

#include <osg/CopyOp>

#include <cctype>
#include <cmath>
#include <limits>
#include <set>

namespace
{

using geofx::test::allProperties;
using geofx::test::alteredEffect;
using geofx::test::expectSame;
using geofx::test::isWhole;
using geofx::test::NotifyWatch;
using geofx::test::otherValues;
using geofx::test::PropertyRow;
using geofx::test::Random;
using geofx::test::sampleCount;
using geofx::test::Typed;
using geofx::test::TypedSetters;
using geofx::test::typedSetters;
using osgGeoFX::BirdsEyeView;
using osgGeoFX::BlendedView;
using osgGeoFX::createEffect;
using osgGeoFX::createPropertyHolder;
using osgGeoFX::Effect;
using osgGeoFX::effectKinds;
using osgGeoFX::PerspectiveBend;
using osgGeoFX::Property;
using osgGeoFX::PropertyHolder;
using osgGeoFX::propertyHolderKinds;

using Kind = Property::Kind;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();

/// One sentence that begins with the class and names the property as people type it.
void expectSentence(const std::string& error, const PropertyHolder& holder, const Property& property)
{
    EXPECT_EQ(error.rfind(std::string(holder.className()) + ": ", 0), 0u) << error;
    EXPECT_NE(error.find(property.name), std::string::npos) << error;
    EXPECT_EQ(error.back(), '.') << error;
}

/// What is asked of a property, with an object of its own.
class OneProperty
{
public:
    explicit OneProperty(const PropertyRow& row) : _row(row), _property(row.property()), _holder(row.create())
    {
    }

    void hasTheTablesDefault();
    void takesWhatIsInRangeAndRaisesTheRevision();
    void refusesTheRestWithASentenceAndKeepsTheLastGoodState();
    void comesBackFromItsText();
    void isCloned();
    void hasATypedSetterThatAgrees();

private:
    const PropertyRow& _row;
    const Property& _property;
    const osg::ref_ptr<PropertyHolder> _holder;
    std::string _error;

    bool set(double value) { return _holder->setProperty(_property.name, value, _error); }
    double value() const { return _holder->getProperty(_property.name); }
};

/// All properties of a class in one process: there are some 300.
class EveryProperty : public testing::TestWithParam<std::string>
{
protected:
    static void forEach(void (OneProperty::*asked)())
    {
        std::size_t count = 0;
        for (const PropertyRow& row : allProperties())
        {
            if (row.kind != GetParam()) continue;
            SCOPED_TRACE(row.kind + "." + row.name);
            OneProperty property(row);
            (property.*asked)();
            if (HasFatalFailure()) return;
            ++count;
        }
        EXPECT_GT(count, 0u);
    }
};

INSTANTIATE_TEST_SUITE_P(All, EveryProperty, testing::ValuesIn(propertyHolderKinds()),
                         [](const auto& kind) { return kind.param; });

void OneProperty::hasTheTablesDefault()
{
    EXPECT_TRUE(std::islower(static_cast<unsigned char>(_property.name[0])));
    EXPECT_LT(_property.minimum, _property.maximum);
    EXPECT_EQ(_property.refusal(_property.defaultValue), "");
    EXPECT_EQ(value(), _property.defaultValue);
    EXPECT_EQ(_property.choices.empty(), _property.kind != Kind::Choice);
    EXPECT_GE(otherValues(_row).size(), 1u);
}

TEST_P(EveryProperty, HasTheTablesDefault)
{
    forEach(&OneProperty::hasTheTablesDefault);
}

void OneProperty::takesWhatIsInRangeAndRaisesTheRevision()
{
    for (const double wanted : otherValues(_row))
    {
        ASSERT_TRUE(set(_property.defaultValue)) << _error;
        const unsigned int before = _holder->revision();
        EXPECT_TRUE(set(wanted)) << _error;
        EXPECT_EQ(_error, "");
        EXPECT_EQ(value(), wanted);
        EXPECT_GT(_holder->revision(), before);
        const unsigned int after = _holder->revision();
        EXPECT_TRUE(set(wanted));
        EXPECT_EQ(_holder->revision(), after) << "nothing has changed";
    }
}

TEST_P(EveryProperty, TakesWhatIsInRangeAndRaisesTheRevision)
{
    forEach(&OneProperty::takesWhatIsInRangeAndRaisesTheRevision);
}

void OneProperty::refusesTheRestWithASentenceAndKeepsTheLastGoodState()
{
    const double good = otherValues(_row).at(0);
    ASSERT_TRUE(set(good));
    const unsigned int before = _holder->revision();
    std::vector<double> wrong = {std::nextafter(_property.minimum, -infinity),
                                 std::nextafter(_property.maximum, infinity),
                                 -infinity,
                                 infinity,
                                 notANumber,
                                 -1e300,
                                 1e300};
    if (isWhole(_property)) wrong.insert(wrong.end(), {_property.minimum + 0.5, _property.maximum - 0.25});
    for (const double value : wrong)
    {
        EXPECT_FALSE(set(value)) << value;
        expectSentence(_error, *_holder, _property);
        EXPECT_FALSE(_holder->setProperties({{_property.name, value}}, _error)) << value;
        expectSentence(_error, *_holder, _property);
        EXPECT_EQ(this->value(), good) << value;
    }
    EXPECT_EQ(_holder->revision(), before);
}

TEST_P(EveryProperty, RefusesTheRestWithASentenceAndKeepsTheLastGoodState)
{
    forEach(&OneProperty::refusesTheRestWithASentenceAndKeepsTheLastGoodState);
}

void OneProperty::comesBackFromItsText()
{
    std::vector<double> values = otherValues(_row);
    values.insert(values.end(), {_property.defaultValue, _property.minimum, _property.maximum});
    for (int i = 0; i < sampleCount() / 50; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const double value = random.uniform(_property.minimum, _property.maximum);
        values.push_back(isWhole(_property) ? std::floor(value) : value);
    }
    for (const double value : values)
    {
        double parsed = notANumber;
        ASSERT_TRUE(_property.parse(_property.text(value), parsed, _error))
            << _property.text(value) << ": " << _error;
        // Degrees and back may round.
        if (_property.kind == Kind::Angle)
            EXPECT_DOUBLE_EQ(parsed, value);
        else
            EXPECT_EQ(parsed, value) << _property.text(value);
    }
    const double other = otherValues(_row).at(0);
    EXPECT_TRUE(_holder->setPropertyText(_property.name, _property.text(other), _error)) << _error;
    EXPECT_DOUBLE_EQ(value(), other);
    const double last = value();
    for (const char* text : {"", " ", "x", "1 x", " 1", "0x1", "nan", "inf", "-inf", "1e999", "TRUE", "1,5"})
    {
        double untouched = 42.0;
        EXPECT_FALSE(_property.parse(text, untouched, _error)) << text;
        EXPECT_EQ(untouched, 42.0) << text;
        EXPECT_FALSE(_holder->setPropertyText(_property.name, text, _error)) << text;
        expectSentence(_error, *_holder, _property);
        EXPECT_EQ(value(), last) << text;
    }
}

TEST_P(EveryProperty, ComesBackFromItsText)
{
    forEach(&OneProperty::comesBackFromItsText);
}

void OneProperty::isCloned()
{
    const NotifyWatch watch;
    for (const double wanted : otherValues(_row))
    {
        ASSERT_TRUE(set(wanted));
        for (const osg::CopyOp& copy :
             {osg::CopyOp(osg::CopyOp::SHALLOW_COPY), osg::CopyOp(osg::CopyOp::DEEP_COPY_ALL)})
        {
            const osg::ref_ptr<PropertyHolder> clone = osg::clone(_holder.get(), copy);
            EXPECT_NE(clone, _holder);
            expectSame(*clone, *_holder);
        }
    }
}

TEST_P(EveryProperty, IsCloned)
{
    forEach(&OneProperty::isCloned);
}

void OneProperty::hasATypedSetterThatAgrees()
{
    NotifyWatch watch;
    const TypedSetters& setters = typedSetters(_row.kind);
    ASSERT_TRUE(setters.count(_property.name)) << "add its setter to the tables in TypedSetters.h";
    const Typed& setter = setters.at(_property.name);
    EXPECT_EQ(setter.get(*_holder), _property.defaultValue);
    for (const double wanted : otherValues(_row))
    {
        EXPECT_TRUE(setter.set(*_holder, wanted));
        EXPECT_EQ(value(), wanted);
        EXPECT_EQ(setter.get(*_holder), wanted);
        ASSERT_TRUE(set(_property.defaultValue));
        EXPECT_EQ(setter.get(*_holder), _property.defaultValue);
    }
    if (_property.kind == Kind::Flag || _property.kind == Kind::Choice) return;
    // A refusal is one warning of OSG.
    const std::vector<std::string> said =
        watch.messagesOf([&] { EXPECT_FALSE(setter.set(*_holder, 2.0 * _property.maximum + 1.0)); });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("osgGeoFX: "), std::string::npos) << said[0];
    EXPECT_NE(said[0].find(_property.name), std::string::npos) << said[0];
    EXPECT_EQ(value(), _property.defaultValue);
}

TEST_P(EveryProperty, HasATypedSetterThatAgrees)
{
    forEach(&OneProperty::hasATypedSetterThatAgrees);
}

TEST(Holders, HaveNamesAndNoPropertyTwice)
{
    for (const std::string& kind : propertyHolderKinds())
    {
        const osg::ref_ptr<PropertyHolder> holder = createPropertyHolder(kind);
        ASSERT_TRUE(holder) << kind;
        EXPECT_EQ(osgGeoFX::kindOf(*holder), kind);
        EXPECT_STREQ(holder->libraryName(), "osgGeoFX");
        std::set<std::string> names;
        for (const Property& property : holder->properties())
            EXPECT_TRUE(names.insert(property.name).second) << kind << " " << property.name;
        std::string error;
        EXPECT_FALSE(holder->setProperty("nothing", 1.0, error));
        EXPECT_NE(error.find("has no property nothing."), std::string::npos) << error;
        EXPECT_FALSE(holder->setProperties({{"nothing", 1.0}}, error));
        EXPECT_NE(error.find("nothing."), std::string::npos) << error;
        EXPECT_FALSE(holder->setPropertyText("nothing", "1", error));
        EXPECT_FALSE(holder->setPropertyText("nothing.enabled", "true", error));
    }
}

TEST(Holders, TellTheirListenersOfEachChange)
{
    class Counter final : public osgGeoFX::PropertyListener
    {
    public:
        void propertyChanged(PropertyHolder&) override { ++count; }
        int count = 0;
    };
    for (const std::string& kind : propertyHolderKinds())
    {
        const osg::ref_ptr<PropertyHolder> holder = createPropertyHolder(kind);
        Counter counter;
        holder->addListener(counter);
        int expected = 0;
        for (const Property& property : holder->properties())
        {
            const unsigned int before = holder->revision();
            std::string error;
            for (const double value : geofx::test::candidateValues(property))
                holder->setProperty(property.name, value, error);
            expected += static_cast<int>(holder->revision() - before);
            EXPECT_EQ(counter.count, expected) << kind << " " << property.name;
        }
        EXPECT_GT(counter.count, 0) << kind;
        holder->removeListener(counter);
        geofx::test::alter(*holder);
        EXPECT_EQ(counter.count, expected) << kind;
    }
}

TEST(Effects, HaveKinds)
{
    for (const std::string& kind : effectKinds())
    {
        const osg::ref_ptr<Effect> effect = createEffect(kind);
        ASSERT_TRUE(effect) << kind;
        EXPECT_EQ(effect->properties().at(0).name, "enabled");
    }
    EXPECT_FALSE(createEffect("nothing"));
}

TEST(Effects, ClonesOfPartsAreDeepOrShared)
{
    const osg::ref_ptr<Effect> effect = alteredEffect("blendedView");
    auto& view = static_cast<BlendedView&>(*effect);
    const osg::ref_ptr<BlendedView> shallow = osg::clone(&view, osg::CopyOp::SHALLOW_COPY);
    const osg::ref_ptr<BlendedView> deep = osg::clone(&view, osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_EQ(shallow->getBirdsEyeView(), view.getBirdsEyeView());
    EXPECT_EQ(shallow->getPedestrianView(), view.getPedestrianView());
    EXPECT_NE(deep->getBirdsEyeView(), view.getBirdsEyeView());
    EXPECT_NE(deep->getPedestrianView(), view.getPedestrianView());
    expectSame(*deep, view);
}

TEST(Effects, PartsCannotBeTakenAway)
{
    NotifyWatch watch;
    const osg::ref_ptr<BlendedView> view = new BlendedView;
    const auto said = watch.messagesOf(
        [&]
        {
            EXPECT_FALSE(view->setBirdsEyeView(nullptr));
            EXPECT_FALSE(view->setPedestrianView(nullptr));
        });
    EXPECT_EQ(said.size(), 2u);
    EXPECT_TRUE(view->getBirdsEyeView() && view->getPedestrianView());
    const unsigned int before = view->revision();
    EXPECT_TRUE(view->setBirdsEyeView(new BirdsEyeView));
    EXPECT_GT(view->revision(), before);
    std::string error;
    const unsigned int after = view->revision();
    EXPECT_TRUE(view->setPropertyText("pedestrianView.zoneWidth", "7", error)) << error;
    EXPECT_EQ(view->getPedestrianView()->getZoneWidth(), 7.0);
    EXPECT_GT(view->revision(), after);
}

/// Two properties of which the first must be the lesser.
struct Pair
{
    const char* kind;
    const char* less;
    const char* more;
};

class PropertyPair : public testing::TestWithParam<Pair>
{
};

INSTANTIATE_TEST_SUITE_P(All, PropertyPair,
                         testing::Values(Pair{"birdsEyeView", "focusLine", "horizonLine"},
                                         Pair{"blendedView", "lowHeight", "highHeight"}),
                         [](const auto& pair) { return std::string(pair.param.kind); });

TEST_P(PropertyPair, RefusesWhatDoesNotFit)
{
    const auto [kind, less, more] = GetParam();
    const osg::ref_ptr<Effect> effect = createEffect(kind);
    const Property& lesser = *effect->property(less);
    const Property& greater = *effect->property(more);
    std::string error;
    for (const double value : {greater.defaultValue, greater.maximum})
    {
        EXPECT_FALSE(effect->setProperty(less, value, error)) << value;
        expectSentence(error, *effect, lesser);
        EXPECT_NE(error.find(more), std::string::npos) << error;
        EXPECT_EQ(effect->getProperty(less), lesser.defaultValue);
    }
    EXPECT_FALSE(effect->setProperty(more, lesser.defaultValue, error));
    EXPECT_EQ(effect->getProperty(more), greater.defaultValue);
    EXPECT_EQ(effect->revision(), 0u);
}

TEST_P(PropertyPair, FitsInTheEndWhateverTheOrder)
{
    const auto [kind, less, more] = GetParam();
    const osg::ref_ptr<Effect> effect = createEffect(kind);
    const Property& range = *effect->property(less);
    std::string error;
    int taken = 0;
    for (int i = 0; i < sampleCount(); ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const double low = random.uniform(range.minimum, range.maximum);
        const double high = random.integer(0, 9) == 0 ? low : random.uniform(range.minimum, range.maximum);
        const double formerLow = effect->getProperty(less);
        const double formerHigh = effect->getProperty(more);
        const unsigned int before = effect->revision();
        const bool fits = low < high;
        EXPECT_EQ(effect->setProperties({{less, low}, {more, high}}, error), fits) << "sample " << i;
        EXPECT_LT(effect->getProperty(less), effect->getProperty(more)) << "sample " << i;
        EXPECT_EQ(error.empty(), fits) << error;
        if (fits)
        {
            EXPECT_EQ(effect->getProperty(less), low) << "sample " << i;
            EXPECT_EQ(effect->getProperty(more), high) << "sample " << i;
            EXPECT_GT(effect->revision(), before);
            ++taken;
            continue;
        }
        // One of them may still be taken, never both, and one is whenever it can be.
        const bool hasLow = effect->getProperty(less) == low;
        const bool hasHigh = effect->getProperty(more) == high;
        EXPECT_EQ(hasLow || hasHigh, low < formerHigh || formerLow < high) << "sample " << i;
        EXPECT_EQ(effect->getProperty(less), hasLow ? low : formerLow);
        EXPECT_EQ(effect->getProperty(more), hasHigh ? high : formerHigh);
    }
    EXPECT_GT(taken, sampleCount() / 4);
}

/// An effect in which two properties must fit each other, and two others, too.
class TwoPairs : public Effect
{
public:
    TwoPairs() = default;
    TwoPairs(const TwoPairs& other, const osg::CopyOp& copy) : Effect(other, copy) {}
    META_Object(test, TwoPairs);

    const osgGeoFX::Properties& properties() const override
    {
        static const osgGeoFX::Properties all = osgGeoFX::withDefaultsOf(
            new TwoPairs,
            {
                enabledProperty(),
                Property::number("a", "the less of the first pair", 0.0, 100.0).of<&TwoPairs::_a>(),
                Property::number("b", "the more of the first pair", 0.0, 100.0).of<&TwoPairs::_b>(),
                Property::number("c", "the less of the second pair", 0.0, 100.0).of<&TwoPairs::_c>(),
                Property::number("d", "the more of the second pair", 0.0, 100.0).of<&TwoPairs::_d>(),
            });
        return all;
    }

protected:
    ~TwoPairs() override = default;
    std::string inconsistency() const override
    {
        if (_a >= _b) return "a must be less than b.";
        return _c >= _d ? "c must be less than d." : "";
    }

private:
    double _a = 1.0, _b = 2.0, _c = 1.0, _d = 2.0;
};

TEST(Effects, TakeAllThatFitsBesideWhatDoesNot)
{
    const osg::ref_ptr<TwoPairs> effect = new TwoPairs;
    std::string error;
    // c fits only when d has been set, which comes after it.
    EXPECT_FALSE(
        effect->setProperties({{"a", 9.0}, {"b", 8.0}, {"c", 5.0}, {"d", 6.0}, {"enabled", 7.0}}, error));
    EXPECT_EQ(effect->getProperty("a"), 1.0);
    EXPECT_EQ(effect->getProperty("b"), 8.0);
    EXPECT_EQ(effect->getProperty("c"), 5.0);
    EXPECT_EQ(effect->getProperty("d"), 6.0);
    EXPECT_EQ(error, "TwoPairs: enabled must lie between 0 and 1, not 7. TwoPairs: a must be less than b.");
    EXPECT_TRUE(effect->setProperties({}, error));
    EXPECT_EQ(error, "");
}

TEST(Effects, AreParsedFromALineInAnyOrder)
{
    std::string error;
    const osg::ref_ptr<Effect> view = osgGeoFX::parseEffect(
        "birdsEyeView focusLine=0.9 horizonLine=0.95 enabled=false curve=bezier", error);
    ASSERT_TRUE(view) << error;
    EXPECT_EQ(view->getProperty("focusLine"), 0.9);
    EXPECT_EQ(view->getProperty("horizonLine"), 0.95);
    EXPECT_EQ(view->getProperty("enabled"), 0.0);
    EXPECT_EQ(view->getProperty("curve"), PerspectiveBend::BEZIER);
    const osg::ref_ptr<Effect> blended = osgGeoFX::parseEffect(
        "blendedView birdsEyeView.horizonLine=0.2 highHeight=10000 birdsEyeView.focusLine=0.1 "
        "pedestrianView.bendAngle=45 lowHeight=5000 lowHeight=6000",
        error);
    ASSERT_TRUE(blended) << error;
    auto& parts = static_cast<BlendedView&>(*blended);
    EXPECT_EQ(parts.getBirdsEyeView()->getFocusLine(), 0.1);
    EXPECT_EQ(parts.getBirdsEyeView()->getHorizonLine(), 0.2);
    EXPECT_DOUBLE_EQ(parts.getPedestrianView()->getBendAngle(), osg::PI_4);
    EXPECT_EQ(parts.getLowHeight(), 6000.0);
    EXPECT_EQ(parts.getHighHeight(), 10000.0);
    for (const char* wrong :
         {"", "nothing", "birdsEyeView focusLine", "birdsEyeView focusLine=0.9",
          "birdsEyeView focusLine=0.95 horizonLine=0.9", "birdsEyeView lowHeight=1",
          "blendedView birdsEyeView.focusLine=0.9", "blendedView birdsEyeView.zoneWidth=1",
          "blendedView birdsEyeView=1", "pedestrianView bendAngleDegrees=1", "pedestrianView bendAngle=91"})
    {
        EXPECT_FALSE(osgGeoFX::parseEffect(wrong, error)) << wrong;
        EXPECT_GT(error.size(), 10u) << wrong;
    }
}

TEST(Effects, ThatALineCannotSayAllOfAreRefusedWithTheRemedy)
{
    const std::pair<const char*, const char*> cases[] = {
        {"closeUps", "<closeUp>"},
        {"closeUps supersampling=2 enabled=false", "<closeUp>"},
        {"projectiveMappings", "<raster> or <mapping>"},
    };
    for (const auto& [line, remedy] : cases)
    {
        std::string error;
        EXPECT_FALSE(osgGeoFX::parseEffect(line, error)) << line;
        EXPECT_NE(error.find("draws nothing, because"), std::string::npos) << error;
        EXPECT_NE(error.find(remedy), std::string::npos) << error;
        EXPECT_NE(error.find(".geofx scene"), std::string::npos) << error;
    }
    // What is wrong with a property comes first.
    std::string error;
    EXPECT_FALSE(osgGeoFX::parseEffect("closeUps supersampling=200", error));
    EXPECT_NE(error.find("supersampling must be a whole number between"), std::string::npos) << error;

    for (const std::string& kind : osgGeoFX::effectKinds())
    {
        const bool needsParts = kind == "closeUps" || kind == "projectiveMappings";
        EXPECT_EQ(osgGeoFX::whyItDrawsNothing(*osgGeoFX::createEffect(kind)).empty(), !needsParts) << kind;
    }
    const osg::ref_ptr<osgGeoFX::CloseUps> closeUps = new osgGeoFX::CloseUps;
    closeUps->addCloseUp(new osgGeoFX::CloseUp);
    EXPECT_EQ(osgGeoFX::whyItDrawsNothing(*closeUps), "");
    const osg::ref_ptr<osgGeoFX::ProjectiveMappings> mappings = new osgGeoFX::ProjectiveMappings;
    mappings->addMapping(new osgGeoFX::ProjectiveMapping);
    EXPECT_EQ(osgGeoFX::whyItDrawsNothing(*mappings), "");
}

} // namespace

namespace
{

TEST(Effects, AreExplainedByTheProgramsHelp)
{
    const std::string help = osgGeoFX::effectsHelp();
    for (const std::string& kind : effectKinds())
    {
        const std::string head = kind + ": " + osgGeoFX::describeKind(kind) + "\n";
        const std::size_t begin = help.find(head);
        ASSERT_NE(begin, std::string::npos) << kind;
        const std::string own = help.substr(begin, help.find("\n\n", begin) - begin);
        const osg::ref_ptr<Effect> effect = createEffect(kind);
        for (const Property& property : effect->properties())
            EXPECT_NE(own.find("\n  " + property.name + "=" + property.text(property.defaultValue) + "  " +
                               property.description.substr(0, property.description.find(';'))),
                      std::string::npos)
                << kind << "." << property.name;
    }
    for (const std::string& kind : propertyHolderKinds())
    {
        EXPECT_FALSE(osgGeoFX::describeKind(kind).empty()) << kind;
        for (const Property& property : createPropertyHolder(kind)->properties())
            EXPECT_FALSE(property.description.empty()) << kind << "." << property.name;
    }
    EXPECT_EQ(osgGeoFX::describeKind("nothing"), "");
    EXPECT_FALSE(createPropertyHolder("nothing"));
}

} // namespace
