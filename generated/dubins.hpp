// Made by etlc 0.2.0 from dubins.etl: change that, and run etlc again.
//
//   made from                XXH64
//   dubins.etl               36ff2197c664b658
//   target sets and weights  5e0b6aabc069c56e
//   thresholds               0b71a727755def02
//
//   monitor       about       state B  targets B  operations  distance elements
//   reach         the prefix       16       1024           3                256
//   avoid         the prefix       16       1024           3                256
//   reach_avoid   the prefix       32       2048          10                512
//   sequential    the prefix       32       2048           7                512
//   all together                   60       3072          17                768
//
//   predicate  measures                       threshold  origin
//   at_a       min cosine(z, goal_a) <=       0.243      written in the spec; no guarantee
//   at_b       min cosine(z, goal_b) <=       0.223      written in the spec; no guarantee
//   near_c     min cosine(z, obstacle_c) <=   0.732      written in the spec; no guarantee
//
// state B: of a monitor alone, what it shares with others counted in each. operations: min, max and
// comparisons of robustness keys in the worst step. distance elements: target elements that a step
// compares with its input.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "etlmon/distance/kernel.hpp"
#include "etlmon/scalars.hpp"
#include "etlmon/temporal/predicate.hpp"
#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "etlmon/version.hpp"

#if ETLMON_VERSION_MAJOR != 0 || ETLMON_VERSION_MINOR != 2
#error "made by etlc 0.2: run etlc again, or use the etlmon 0.2 that it was made for"
#endif

namespace dubins {
inline namespace ETLMON_BUILD {  // units compiled with other flags have another class

/// What the monitors see at one step. Inputs{} lacks everything.
struct Inputs {
  etlmon::Vector<float, 32> z;
};

/// What they answer: about the prefix so far or, sliding, about the position their horizon ago.
struct Verdicts {
  etlmon::Verdict reach;        // dubins.etl:25: monitor reach = F at_a
  etlmon::Verdict avoid;        // dubins.etl:26: monitor avoid = G !near_c
  etlmon::Verdict reach_avoid;  // dubins.etl:27: monitor reach_avoid = F at_a && G !near_c
  etlmon::Verdict sequential;   // dubins.etl:28: monitor sequential = F (at_a && F at_b)
};

/// The verdicts by name: for (const auto& [name, verdict] : named(verdicts)) ...
inline etlmon::Named<etlmon::Verdict, 4> named(const Verdicts& verdicts) noexcept {
  return {{
    {"reach", verdicts.reach},
    {"avoid", verdicts.avoid},
    {"reach_avoid", verdicts.reach_avoid},
    {"sequential", verdicts.sequential}
  }};
}

/// Target sets, a row after the other.
namespace targets {
/// targets/goal_a.npy: 8 rows of 32 elements, scaled to length 1
alignas(64) inline constexpr float goal_a_unit[8 * 32] = {
  // row 0
  -0.0277459f, 0.41362104f, 0.2236006f, 0.13563636f, -0.26795056f, -0.41859886f, 0.07082906f,
  0.15879865f, 0.064182766f, -0.25145262f, -0.08799896f, 0.12988909f, -0.2560078f, -0.061131883f,
  0.0009510006f, 0.017119007f, -0.09616781f, -0.19748276f, 0.0042369943f, 0.22171077f,
  -0.020170774f, 0.021977963f, -0.17932448f, -0.161282f, 0.2677239f, -0.06555763f, -0.070459075f,
  -0.08030399f, 0.21011618f, 0.1386716f, 0.09896897f, -0.06262762f,
  // row 1
  -0.03037539f, 0.4119727f, 0.23110491f, 0.13881363f, -0.2614752f, -0.4267857f, 0.05691172f,
  0.15551467f, 0.06270705f, -0.2660227f, -0.07399856f, 0.14441226f, -0.2507783f, -0.06165257f,
  0.007945933f, 0.0030543972f, -0.09838231f, -0.17387243f, -0.0022956477f, 0.22048773f,
  -0.015801454f, 0.0069904537f, -0.17568535f, -0.16097793f, 0.2645637f, -0.058532644f, -0.07911505f,
  -0.08702341f, 0.21657194f, 0.13529149f, 0.095781155f, -0.06084186f,
  // row 2
  -0.035889577f, 0.4175086f, 0.23576005f, 0.1469987f, -0.25839764f, -0.42529428f, 0.046862364f,
  0.15129654f, 0.059897386f, -0.24904193f, -0.05949429f, 0.13979933f, -0.259804f, -0.05519463f,
  0.029267801f, 0.007899383f, -0.11288323f, -0.16283908f, -0.0028963513f, 0.2323877f,
  -0.0110015245f, -0.009734466f, -0.17510518f, -0.16619064f, 0.2624301f, -0.052655824f,
  -0.088402055f, -0.08261907f, 0.2180448f, 0.12773877f, 0.09019079f, -0.065364294f,
  // row 3
  -0.042336516f, 0.42561477f, 0.23982924f, 0.15609767f, -0.256867f, -0.42180738f, 0.03952553f,
  0.14810507f, 0.05737119f, -0.2273412f, -0.048712093f, 0.13101438f, -0.27040341f, -0.05067372f,
  0.047009263f, 0.016445763f, -0.12329841f, -0.1609314f, -0.001968229f, 0.24018617f, -0.0041760053f,
  -0.016312554f, -0.17492533f, -0.1643014f, 0.264133f, -0.05194298f, -0.09181823f, -0.07639568f,
  0.21114014f, 0.123876475f, 0.08104323f, -0.0721082f,
  // row 4
  -0.042699046f, 0.43001014f, 0.23254468f, 0.15753466f, -0.26337987f, -0.4129113f, 0.05140941f,
  0.15194206f, 0.062117893f, -0.20553665f, -0.057386562f, 0.11381397f, -0.28340998f, -0.05322746f,
  0.044752914f, 0.024947856f, -0.12552819f, -0.1824357f, -0.003910055f, 0.23561233f, -0.0029224302f,
  -0.01098406f, -0.17795776f, -0.15950586f, 0.26724634f, -0.06329716f, -0.09667382f, -0.06478976f,
  0.20098938f, 0.1252333f, 0.082481496f, -0.08358606f,
  // row 5
  -0.038388982f, 0.43297794f, 0.22220348f, 0.15357158f, -0.27380335f, -0.40604946f, 0.070093095f,
  0.1574828f, 0.06765597f, -0.19387743f, -0.07372106f, 0.09999783f, -0.2899459f, -0.05414055f,
  0.033354692f, 0.0306432f, -0.12453578f, -0.2028732f, -0.0049144533f, 0.22779801f, -0.01143915f,
  -0.0049621626f, -0.1793309f, -0.15994309f, 0.26068237f, -0.072673574f, -0.09839299f, -0.05518425f,
  0.19425727f, 0.12487528f, 0.09136504f, -0.08813513f,
  // row 6
  -0.030586842f, 0.42651814f, 0.21654032f, 0.14266087f, -0.27768326f, -0.4065774f, 0.08182783f,
  0.16034603f, 0.06671181f, -0.20984335f, -0.090275146f, 0.104020916f, -0.2787035f, -0.053948916f,
  0.015384715f, 0.033096235f, -0.11380598f, -0.2118414f, 0.0023815196f, 0.22632502f, -0.022785336f,
  0.009216675f, -0.1816387f, -0.16592495f, 0.25769493f, -0.07311386f, -0.086842164f, -0.0630076f,
  0.19859688f, 0.12818117f, 0.101417415f, -0.07814516f,
  // row 7
  -0.025973279f, 0.4193547f, 0.21684138f, 0.13463679f, -0.27615902f, -0.41102898f, 0.084014654f,
  0.1615046f, 0.064749375f, -0.23300186f, -0.09894068f, 0.114872836f, -0.2635702f, -0.05740793f,
  -0.00018632354f, 0.030800859f, -0.09913251f, -0.21364108f, 0.008955902f, 0.22410859f,
  -0.02596294f, 0.026158705f, -0.18117514f, -0.16465478f, 0.2616355f, -0.069438964f, -0.07016786f,
  -0.07301123f, 0.20312366f, 0.13409482f, 0.10338148f, -0.065283105f
};
/// targets/goal_b.npy: 8 rows of 32 elements, scaled to length 1
alignas(64) inline constexpr float goal_b_unit[8 * 32] = {
  // row 0
  -0.2455571f, -0.08734829f, 0.06686829f, -0.37340024f, 0.18151182f, -0.025265714f, 0.2729943f,
  -0.38588098f, 0.15643162f, -0.22651888f, -0.07369623f, -0.21777229f, -0.20224904f, 0.06467084f,
  0.27830914f, -0.092199124f, -0.15392207f, 0.027110452f, -0.058849894f, 0.13272583f, 0.052583147f,
  0.08260031f, 0.045962784f, 0.28198737f, -0.059205573f, 0.12517218f, 0.08921509f, -0.10478876f,
  -0.21681456f, 0.19991651f, 0.05986736f, 0.07797699f,
  // row 1
  -0.23550671f, -0.082407214f, 0.07129563f, -0.36919394f, 0.18036638f, -0.024819331f, 0.26886067f,
  -0.3935076f, 0.16020332f, -0.23158088f, -0.076506265f, -0.23454444f, -0.19034365f, 0.06488432f,
  0.2863105f, -0.1056824f, -0.14773539f, 0.012009413f, -0.050111704f, 0.13042402f, 0.05534535f,
  0.06575924f, 0.055587534f, 0.27433902f, -0.044528596f, 0.12690185f, 0.0906863f, -0.11163989f,
  -0.22150944f, 0.18910292f, 0.057722833f, 0.09039006f,
  // row 2
  -0.22532983f, -0.08244843f, 0.07248676f, -0.37080607f, 0.17391062f, -0.035760466f, 0.2675838f,
  -0.3991462f, 0.16842636f, -0.22995187f, -0.063296944f, -0.24864185f, -0.18509468f, 0.06161175f,
  0.3025326f, -0.10630372f, -0.13034464f, 0.009412299f, -0.035556212f, 0.116803594f, 0.0545773f,
  0.07136515f, 0.058960993f, 0.26928243f, -0.045281764f, 0.11950099f, 0.089494586f, -0.11588982f,
  -0.21754664f, 0.18652447f, 0.06678369f, 0.094246f,
  // row 3
  -0.21894094f, -0.08345371f, 0.07349819f, -0.374782f, 0.16894642f, -0.046623792f, 0.267979f,
  -0.4059504f, 0.1768186f, -0.22695233f, -0.048758075f, -0.26113206f, -0.18191127f, 0.056327f,
  0.3168332f, -0.10350265f, -0.10969067f, 0.010909785f, -0.02187348f, 0.10218875f, 0.051413115f,
  0.08251163f, 0.05472677f, 0.26096982f, -0.052972935f, 0.110778086f, 0.08231944f, -0.119054615f,
  -0.20434263f, 0.19015534f, 0.07377022f, 0.090567484f,
  // row 4
  -0.22260411f, -0.08761944f, 0.0717414f, -0.38082206f, 0.16696201f, -0.053430136f, 0.27019274f,
  -0.4045788f, 0.17663613f, -0.21827964f, -0.039066546f, -0.25194684f, -0.1882857f, 0.054110054f,
  0.30874297f, -0.08878164f, -0.106736995f, 0.024000343f, -0.032700535f, 0.10123198f, 0.0436317f,
  0.10093809f, 0.0409462f, 0.2687421f, -0.064983204f, 0.11550545f, 0.07088931f, -0.11203067f,
  -0.19643015f, 0.20662335f, 0.07760821f, 0.08959072f,
  // row 5
  -0.22908558f, -0.09290808f, 0.06915607f, -0.3872899f, 0.16557881f, -0.0590321f, 0.27243724f,
  -0.40091893f, 0.17340042f, -0.20870656f, -0.032208886f, -0.23766385f, -0.1960332f, 0.054747555f,
  0.29577905f, -0.074097075f, -0.11082289f, 0.03563751f, -0.04760154f, 0.1029496f, 0.037275184f,
  0.11499943f, 0.032940637f, 0.27918553f, -0.07031752f, 0.12056188f, 0.0643569f, -0.10467059f,
  -0.19353467f, 0.2130405f, 0.082989424f, 0.091302924f,
  // row 6
  -0.2401344f, -0.09523699f, 0.064961605f, -0.38557953f, 0.17004825f, -0.049961228f, 0.27449873f,
  -0.38953322f, 0.1638016f, -0.21034531f, -0.04380291f, -0.21843453f, -0.20577948f, 0.061525147f,
  0.2844046f, -0.07130236f, -0.13330369f, 0.040146794f, -0.0587367f, 0.113294944f, 0.041170135f,
  0.11376831f, 0.03822483f, 0.28959355f, -0.06988486f, 0.120781906f, 0.074733414f, -0.09997321f,
  -0.20280409f, 0.20892186f, 0.08101574f, 0.08391767f,
  // row 7
  -0.25118667f, -0.094319016f, 0.06272974f, -0.38119593f, 0.17804138f, -0.0348215f, 0.27655235f,
  -0.381197f, 0.15611559f, -0.21806747f, -0.061357178f, -0.2063872f, -0.2112116f, 0.06522475f,
  0.27645147f, -0.07639205f, -0.15220504f, 0.040016875f, -0.06308437f, 0.12579611f, 0.047041807f,
  0.10298767f, 0.04116311f, 0.28916526f, -0.06905682f, 0.11996895f, 0.085033454f, -0.09700831f,
  -0.20999654f, 0.20458044f, 0.06976935f, 0.07296577f
};
/// targets/obstacle_c.npy: 8 rows of 32 elements, scaled to length 1
alignas(64) inline constexpr float obstacle_c_unit[8 * 32] = {
  // row 0
  0.30888504f, 0.0994509f, -0.14735965f, -0.26837867f, 0.39090276f, -0.0038471671f, -0.3804196f,
  0.32743216f, 0.05834294f, -0.011646228f, 0.01893266f, -0.1300883f, -0.27426833f, 0.04242392f,
  -0.0758262f, -0.0018022127f, 0.077453636f, -0.148094f, 0.08450845f, 0.063275725f, -0.22263062f,
  -0.07375282f, -0.030971209f, 0.21008919f, -0.18876635f, 0.15753031f, 0.039118946f, -0.15354615f,
  0.058939125f, -0.17520109f, 0.033716515f, -0.180477f,
  // row 1
  0.31288686f, 0.1038285f, -0.15608361f, -0.27094203f, 0.38718534f, 0.0045436155f, -0.38103747f,
  0.31494546f, 0.046968147f, -0.013334025f, 0.028769303f, -0.11100427f, -0.27990758f, 0.03145223f,
  -0.0642062f, -0.009610385f, 0.08355219f, -0.16624472f, 0.07964586f, 0.06489602f, -0.22944926f,
  -0.073603354f, -0.03617808f, 0.21027088f, -0.18684852f, 0.15832683f, 0.04291697f, -0.14570683f,
  0.054412596f, -0.1756488f, 0.040263087f, -0.18139443f,
  // row 2
  0.31515056f, 0.10270353f, -0.16142426f, -0.26285517f, 0.38945097f, 0.002128733f, -0.3774463f,
  0.3011885f, 0.052899823f, -0.005469332f, 0.018681781f, -0.088314414f, -0.2875313f, 0.042660303f,
  -0.056727767f, -0.01329956f, 0.10654811f, -0.17063764f, 0.08697772f, 0.0692156f, -0.2292836f,
  -0.08370978f, -0.038021456f, 0.22126907f, -0.18152884f, 0.1644661f, 0.03912296f, -0.13325883f,
  0.05479033f, -0.17255293f, 0.041454695f, -0.1861827f,
  // row 3
  0.31755224f, 0.09865064f, -0.16244234f, -0.25279272f, 0.39698675f, -0.00626137f, -0.3737528f,
  0.29425144f, 0.06500413f, 0.0038906347f, 0.0017793853f, -0.07436472f, -0.2916361f, 0.05631351f,
  -0.0528391f, -0.010255333f, 0.12678212f, -0.16858616f, 0.091656394f, 0.07391768f, -0.22561204f,
  -0.09328581f, -0.030481564f, 0.22789589f, -0.18226172f, 0.16669105f, 0.031722784f, -0.12463836f,
  0.057626683f, -0.16642141f, 0.033331178f, -0.18392305f,
  // row 4
  0.31487805f, 0.093292505f, -0.15239547f, -0.24868613f, 0.40403053f, -0.017135018f, -0.36965603f,
  0.30797404f, 0.07685713f, 0.010387731f, -0.01380901f, -0.08806382f, -0.28337464f, 0.06841828f,
  -0.055746477f, -0.0027797495f, 0.13127996f, -0.1518935f, 0.08651205f, 0.0784252f, -0.22094913f,
  -0.098721854f, -0.021929996f, 0.23334835f, -0.18636182f, 0.15767029f, 0.030113824f, -0.13304327f,
  0.06881963f, -0.16160356f, 0.026316265f, -0.18114243f,
  // row 5
  0.31256405f, 0.09090765f, -0.14342295f, -0.2505553f, 0.40816787f, -0.023719724f, -0.368775f,
  0.32540822f, 0.08480803f, 0.012550973f, -0.021694556f, -0.10968188f, -0.27257606f, 0.07876643f,
  -0.06320096f, 0.001757913f, 0.12568712f, -0.13036406f, 0.08241632f, 0.08016537f, -0.21300155f,
  -0.09853771f, -0.021622218f, 0.23608889f, -0.18268189f, 0.1447376f, 0.032531213f, -0.14157301f,
  0.080138005f, -0.15945238f, 0.02698702f, -0.17888023f,
  // row 6
  0.30875254f, 0.092938244f, -0.14083087f, -0.25770748f, 0.40200788f, -0.01916534f, -0.3736256f,
  0.33349058f, 0.08012849f, 0.0034519795f, -0.010135942f, -0.12940453f, -0.2696966f, 0.07309023f,
  -0.075837314f, 0.0032243088f, 0.103706524f, -0.12335769f, 0.08834367f, 0.072693825f, -0.21055678f,
  -0.08981848f, -0.02710677f, 0.22958623f, -0.17962074f, 0.14771946f, 0.033882257f, -0.14849742f,
  0.07698575f, -0.16501148f, 0.03286195f, -0.18289438f,
  // row 7
  0.30681768f, 0.095589586f, -0.1405782f, -0.2650481f, 0.3963784f, -0.012892617f, -0.37900302f,
  0.33862045f, 0.07170626f, -0.0066989344f, 0.0049071675f, -0.14478415f, -0.26874816f, 0.060062986f,
  -0.085572295f, 0.0045553804f, 0.078862235f, -0.12446553f, 0.09151851f, 0.063438095f, -0.21153568f,
  -0.0779823f, -0.0292312f, 0.21556947f, -0.18134859f, 0.15379198f, 0.03422183f, -0.15611872f,
  0.06675898f, -0.16965072f, 0.033016764f, -0.1819288f
};
}  // namespace targets

/// Every monitor of the spec, stepped together. Any number of instances; none of them shares
/// anything.
class Monitor {
 public:
  using Value = etlmon::Value;      ///< a robustness; its ends differ where a sample is missing
  using Reading = etlmon::Reading;  ///< a value, and bounds that no continuation leaves

  /// What a step says about each predicate.
  struct Atoms {
    etlmon::Value at_a;
    etlmon::Value at_b;
    etlmon::Value near_c;
  };

  /// What the class was made from, as XXH64: log it with the verdicts.
  static constexpr uint64_t kSpecHash = 0x36ff2197c664b658u;        ///< dubins.etl
  static constexpr uint64_t kDataHash = 0x5e0b6aabc069c56eu;        ///< target sets and weights
  static constexpr uint64_t kThresholdsHash = 0x0b71a727755def02u;  ///< thresholds, as they begin
  /// What it costs.
  static constexpr size_t kStateBytes = 60;           ///< sizeof(Monitor)
  static constexpr uint32_t kOperations = 17;         ///< min, max, compare in the worst step
  static constexpr uint32_t kDistanceElements = 768;  ///< target elements measured in a step

  constexpr Monitor() noexcept { reset(); }

  /// A new episode.
  constexpr void reset() noexcept {
    reach_ = etlmon::kFalse;
    avoid_ = etlmon::kTrue;
    sequential_met_ = etlmon::kFalse;
    sequential_owing_1_ = etlmon::kFalse;
    at_a_ = etlmon::kUnmeasured;
    at_b_ = etlmon::kUnmeasured;
    near_c_ = etlmon::kUnmeasured;
    incomplete = 0;
  }

  /// One call, one time step.
  Verdicts step(const Inputs& in) noexcept { return judge(measure(in)); }

  // A step in two halves: step(in) is judge(measure(in)). They share no member that either changes,
  // so one may interrupt the other; every measure() is followed by one judge() of what it gave, in
  // the same order.

  /// The robustness of every predicate at this step; counts the step if something was missing.
  Atoms measure(const Inputs& in) noexcept;
  /// One step of every formula, given this step's predicates.
  Verdicts judge(const Atoms& now) noexcept;

  /// Telemetry of the last step: a predicate's distance or expression, NaN where it was unknown,
  /// next to its threshold, and the row of the nearest target.
  float distance_at_a() const noexcept { return at_a_.delta; }
  static constexpr float threshold_at_a() noexcept { return 0.243f; }
  uint32_t nearest_at_a() const noexcept { return at_a_.nearest; }
  float distance_at_b() const noexcept { return at_b_.delta; }
  static constexpr float threshold_at_b() noexcept { return 0.223f; }
  uint32_t nearest_at_b() const noexcept { return at_b_.nearest; }
  float distance_near_c() const noexcept { return near_c_.delta; }
  static constexpr float threshold_near_c() noexcept { return 0.732f; }
  uint32_t nearest_near_c() const noexcept { return near_c_.nearest; }

  /// Steps on which some predicate or bool input was unknown; saturates.
  uint32_t missing_steps() const noexcept { return incomplete; }

 private:
  /// All that the robustness of a predicate can be: what stands for it where it is not seen.
  static Value unseen_at_a() noexcept {
    return Value{etlmon::key_of(-1.7570001f), etlmon::key_of(0.243f)};
  }
  static Value unseen_at_b() noexcept {
    return Value{etlmon::key_of(-1.7770001f), etlmon::key_of(0.223f)};
  }
  static Value unseen_near_c() noexcept {
    return Value{etlmon::key_of(-1.268f), etlmon::key_of(0.732f)};
  }

  etlmon::Register reach_{};               // F at_a
  etlmon::Register avoid_{};               // G !near_c
  etlmon::Register sequential_met_{};      // nothing is owed any more
  etlmon::Register sequential_owing_1_{};  // owed: F at_b
  etlmon::Measured at_a_{};                // telemetry of at_a
  etlmon::Measured at_b_{};                // telemetry of at_b
  etlmon::Measured near_c_{};              // telemetry of near_c
  uint32_t incomplete{};                   // steps on which something was unknown; saturates
};
static_assert(sizeof(Monitor) == Monitor::kStateBytes, "no padding, no surprises");

inline Monitor::Atoms Monitor::measure(const Inputs& in) noexcept {
  Atoms now;
  bool missing = false;
  // |z|, once for all distances that need it
  const auto z_direction = etlmon::direction_of(in.z);

  // dubins.etl:13: predicate at_a = min cosine(z, goal_a) <= 0.243
  at_a_ = etlmon::measure<etlmon::Cosine, etlmon::Min, 8, 32, targets::goal_a_unit>(z_direction);
  now.at_a = etlmon::at_most(at_a_.delta, threshold_at_a(), unseen_at_a());
  missing = etlmon::is_nan(at_a_.delta) || missing;

  // dubins.etl:14: predicate at_b = min cosine(z, goal_b) <= 0.223
  at_b_ = etlmon::measure<etlmon::Cosine, etlmon::Min, 8, 32, targets::goal_b_unit>(z_direction);
  now.at_b = etlmon::at_most(at_b_.delta, threshold_at_b(), unseen_at_b());
  missing = etlmon::is_nan(at_b_.delta) || missing;

  // dubins.etl:15: predicate near_c = min cosine(z, obstacle_c) <= 0.732
  near_c_ =
      etlmon::measure<etlmon::Cosine, etlmon::Min, 8, 32, targets::obstacle_c_unit>(z_direction);
  now.near_c = etlmon::at_most(near_c_.delta, threshold_near_c(), unseen_near_c());
  missing = etlmon::is_nan(near_c_.delta) || missing;

  if (missing && incomplete != UINT32_MAX) {
    ++incomplete;
  }
  return now;
}

inline Verdicts Monitor::judge(const Atoms& now) noexcept {
  using etlmon::max_of;
  using etlmon::min_of;

  const Value not_near_c = etlmon::negate(now.near_c);

  // dubins.etl:25: F at_a
  reach_ = max_of(reach_, now.at_a);
  const Reading reach_reading = {reach_, reach_.low, max_of(reach_.high, unseen_at_a().high)};

  // dubins.etl:26: G !near_c
  avoid_ = min_of(avoid_, not_near_c);
  const Reading avoid_reading = {avoid_, min_of(avoid_.low, -unseen_near_c().high), avoid_.high};

  // dubins.etl:27: F at_a && G !near_c
  const Reading reach_avoid_reading = min_of(reach_reading, avoid_reading);

  // dubins.etl:28: F (at_a && F at_b)
  sequential_owing_1_ = max_of(sequential_owing_1_, now.at_a);  // owed: F at_b
  // nothing is owed any more
  sequential_met_ = max_of(sequential_met_, min_of(sequential_owing_1_, now.at_b));
  const Reading sequential_reading = {
    sequential_met_,
    sequential_met_.low,
    max_of(sequential_met_.high, unseen_at_b().high)
  };

  Verdicts verdicts;
  verdicts.reach = etlmon::prefix_verdict(reach_reading);
  verdicts.avoid = etlmon::prefix_verdict(avoid_reading);
  verdicts.reach_avoid = etlmon::prefix_verdict(reach_avoid_reading);
  verdicts.sequential = etlmon::prefix_verdict(sequential_reading);
  return verdicts;
}

}  // namespace ETLMON_BUILD
}  // namespace dubins
