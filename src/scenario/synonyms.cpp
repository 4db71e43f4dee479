#include "scenario/synonyms.h"

namespace keyblock::scenario {
namespace {

constexpr Synonym all_synonyms[] = {
    // Rock
    {"e ymod emod youngs youngmodulus youngsmodulus emodulus elasticmodulus", "young", true},
    {"modulus elasticity", "young"},
    {"nu pratio poissons poissonratio poissonsratio", "poisson", true},
    {"v pr", "poisson"},
    {"dens rho massdensity", "density", true},
    // Joints
    {"phi fric frictionangle angleoffriction internalfriction internalfrictionangle jfric jfriction jphi",
     "friction", true},
    {"mu frictioncoefficient tanphi", "friction"},
    {"coh jcoh jcohesion", "cohesion", true},
    {"c", "cohesion"},
    {"phires residualphi frictionresidual phir jrfric residualfrictionangle", "residual_friction", true},
    {"cres cohesionresidual cr jrescoh residualcoh", "residual_cohesion", true},
    {"dc criticalslip slipweakening weakening criticaldisplacement", "weakening_slip", true},
    {"tens jtens jtension tensilestrength", "tension", true},
    {"t ten tensile bond bondstrength", "tension"},
    {"kn jkn", "normal_stiffness", true},
    {"ks jks", "shear_stiffness", true},
    {"knn stiffnessnormal normalstiff", "normal_stiffness"},
    {"kss stiffnessshear shearstiff tangentialstiffness", "shear_stiffness"},
    {"stiffness stiff", "normal_stiffness young"},
    {"jset jointset jointsets", "joint_set", true},
    {"set sets", "joint_set"},
    {"dipdir", "dip_direction", true},
    {"dd ddir dipazimuth azimuth", "dip_direction"},
    {"s distance", "spacing"},
    {"tracelength persistence", "length"},
    {"bridge rockbridge", "gap"},
    {"sd stdev stddev standarddeviation deviation sigma", "std"},
    {"fault faults crack cracks fracture fractures discontinuity discontinuities dfn", "trace_map", true},
    {"trace traces lineament lineaments", "trace_map"},
    // Shapes
    {"tunnel tunnels opening openings cavern adit drift", "excavation", true},
    {"r radius d dia diam", "diameter"},
    {"centre middle", "center"},
    {"height wallheight", "wall_height"},
    {"span", "width"},
    {"rise", "arch_height"},
    {"vertices corners polygon outline ring coordinates coords", "outer points"},
    {"segments", "chords"},
    {"model box extent", "domain"},
    {"bc boundaries boundaryconditions", "boundary"},
    {"blocks brick bricks stone stones", "block"},
    {"material materials", "region rock"},
    {"rotate angle", "rotation"},
    {"fix pinned", "fixed"},
    {"vel speed", "velocity"},
    // Water
    {"groundwater gwt phreatic pore porepressure pp waterpressure fluid", "water", true},
    {"watertable piezo piezometric piezometricline phreaticline phreaticsurface level surface line", "table"},
    {"height elevation waterlevel", "head"},
    {"flooded", "filled", true},
    {"drained", "dry filled"},
    // Stress
    {"insitu insitustress initialstress fieldstress", "in_situ", true},
    {"stress stresses initial", "in_situ"},
    {"ko stressratio lateralstressratio", "k0", true},
    {"k lateral", "k0"},
    {"overburden", "depth", true},
    {"cover burial", "depth"},
    {"sigxx sigmaxx sigmax xx", "sxx"},
    {"sigyy sigmayy sigmay yy", "syy"},
    {"sigxy sigmaxy tauxy tau xy", "sxy"},
    {"grav", "gravity", true},
    {"g", "gravity"},
    // Motion, stages, time
    {"earthquake earthquakes quake accelerogram groundmotion", "shake motion", true},
    {"record records file", "components motion"},
    {"seismic shaking", "shake"},
    {"static equilibrium settling", "settle"},
    {"stages phase phases", "stage"},
    {"type", "kind shape distribution"},
    {"factor amplification scalefactor", "scale"},
    {"f freq hz", "frequency"},
    {"peak", "amplitude"},
    {"time endtime tend", "duration"},
    {"tol accuracy", "tolerance"},
    {"maxcycles ncycles steps nsteps", "max_steps"},
    {"remove excavated excavation excavations", "excavate"},
    {"relax relaxation loadsplit corereplacement", "release", true},
    {"internalpressure supportpressure", "pressure", true},
    {"dt timestep tstep deltat stepsize", "step", true},
    // The rest
    {"pressure", "traction"},
    {"supports", "support"},
    {"springs", "spring"},
    {"liners lining linings shotcrete", "liner"},
    {"bolts rockbolt rockbolts anchor anchors cable cables dowel dowels", "bolt"},
    {"loads", "load"},
    {"hist monitor", "history", true},
    {"damp rayleigh rayleighdamping dampingratio", "damping"},
    {"realisations runs samples", "realizations"},
    {"montecarlo", "study"},
    {"unit unitsystem", "units"},
    {"heading", "title"},
    {"frames", "frame_interval"},
    // Words as values
    {"rectangle rectangular square", "polygon"},
    {"round circular", "circle"},
    {"arch arched", "horseshoe"},
    {"fixed roller", "frame"},
    {"gaussian gauss", "normal"},
    {"negexp negativeexponential", "exponential"},
    {"newmark trapezoidal", "average-acceleration"},
};

constexpr Explanation all_explanations[] = {
    {"beam beams struct steelset steelsets", "steel sets are not in the program; [[liner]] is shotcrete"},
    {"flow seepage permeability conductivity aperture",
     "flow of water in joints is not in the program; [water] is water at rest, below a table"},
    {"dilation dilatancy dilationangle jdil jdilation psi", "dilation of joints is not in the program"},
    {"ucs sigci gsi mi hoekbrown mohrcoulomb plastic plasticity yield failure compressivestrength",
     "the rock between the joints is elastic; its failure is not in the program"},
    {"bulk bulkmodulus shearmodulus", "the rock has young and poisson: E = 9KG / (3K + G), nu = E / 2G - 1"},
    {"gamma unitweight specificweight weight",
     "the rock has a density in kg/m3: its unit weight over the acceleration of gravity"},
    {"nonreflecting quiet absorbing transmitting viscousboundary absorbingboundary",
     "[boundary] lets waves out: base = \"compliant\", sides = \"free-field\" or \"viscous\""},
    {"contact lagrangian augmentedlagrangian multiplier multipliers penetrationtolerance "
     "maxmultiplierupdates uzawa",
     "contacts are springs: normal_stiffness of [joints] or penalty of [solver] says how stiff"},
    {"temperature thermal", "heat is not in the program"},
    {"creep viscosity", "creep is not in the program"},
    {"strike", "joint sets have a dip_direction: the strike + 90 degrees, by the right-hand rule"},
    {"joint", "[joints] has the properties, [[joint_set]] statistics, [[trace_map]] joints one by one"},
    {"fos factorofsafety srf ssr strengthreduction",
     "strength_factor of [joints] divides their strength; keyblock limit finds the factor of safety by --key "
     "joints.strength_factor"},
};

}  // namespace

std::span<const Synonym> synonyms() {
  return all_synonyms;
}

std::span<const Explanation> explanations() {
  return all_explanations;
}

}  // namespace keyblock::scenario
