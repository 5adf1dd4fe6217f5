// SPDX-License-Identifier: GPL-3.0-or-later
// Our includes beside POV-Ray's own of the same name, where they are installed: all that they declare prints
// the same.
#include "evaluate.h"
#include "parser/library.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>

namespace pnr::test {
namespace {

const std::vector<std::string> ours{"arrays", "colors", "consts",  "finish",    "functions",
                                    "math",   "rand",   "strings", "transforms"};

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::set<std::string> declared_names(const std::string& text) {
    static const std::regex declaration(R"((?:^|\n)\s*#(?:declare|macro)\s+(\w+))");
    std::set<std::string> names;
    for (std::sregex_iterator found(text.begin(), text.end(), declaration), end; found != end; ++found)
        names.insert((*found)[1]);
    return names;
}

const std::string printers = R"(
#macro Pr(X) #debug concat(str(X, 0, 8), " ") #end
#macro Vec(X) #debug concat(vstr(3, X, ",", 0, 6), " ") #end
#macro Five(X) #debug concat(vstr(5, X, ",", 0, 6), " ") #end
#macro Trf(T)
    #local Fn = function { transform { T } }
    Vec(Fn(0, 0, 0)) Vec(Fn(1, 0, 0)) Vec(Fn(0, 1, 0)) Vec(Fn(0, 0, 1))
#end
#declare W = <1, 2, 3>;
#declare U = <-2, 0.5, 1>;
#declare C5 = <1, 2, 3, 4, 5>;
)";

const std::string math = R"(#include "math.inc"
#declare A = array[6] {3, 1, 4, 1, 5, 9}
Pr(Mean(A)) Pr(Std_Dev(A, 2)) GetStats(A) #for (I, 0, 4) Pr(StatisticsArray[I]) #end
Pr(sind(30)) Pr(cosd(40)) Pr(tand(50)) Pr(asind(0.3)) Pr(acosd(0.3)) Pr(atand(2)) Pr(atan2d(1, -2))
#for (I, -3, 3) Pr(even(I)) Pr(odd(I)) Pr(sgn(I)) Pr(clip(I, -1, 2)) Pr(clamp(I, -1, 2)) Pr(adj_range(I, 2, 5)) #end
Pr(f_sqr(3)) Pr(max3(1, 5, 2)) Pr(min3(3, 1, 2)) Pr(adj_range2(3, 1, 5, 10, 20))
Pr(Interpolate(2, 1, 5, 10, 20, 0)) Pr(Interpolate(2, 1, 5, 10, 20, 2)) Pr(Interpolate(2, 1, 5, 10, 20, -1))
Vec(VSqr(W)) Vec(VPow(W, 2)) Five(VPow5D(C5, 2)) Pr(VEq(W, U)) Pr(VEq5D(C5, C5)) Pr(VZero(W)) Pr(VZero5D(<0, 0, 0, 0, 1>))
Pr(VLength5D(C5)) Five(VNormalize5D(C5)) Pr(VDot5D(C5, C5 * 2)) Pr(VCos_Angle(W, U)) Pr(VAngle(W, U)) Pr(VAngleD(W, U))
Pr(VRotation(W, U, y)) Pr(VRotation(U, W, y)) Pr(VRotationD(W, U, x + z)) Pr(VDist(W, U)) Pr(VMin(W)) Pr(VMax(W))
Vec(VPerp_To_Vector(W)) Vec(VPerp_To_Vector(<3, 2, 1>)) Vec(VPerp_To_Vector(x)) Vec(VPerp_To_Vector(<0, 0, 0>))
Vec(VPerp_To_Plane(W, U)) Vec(VPerp_Adjust(W, U)) Vec(VProject_Plane(W, U)) Vec(VProject_Axis(W, U)) Vec(VWith_Len(W, 3))
#declare F1 = function { x * x + y * z } #declare F2 = function { sin(x) + y } #declare F3 = function { x * y * z }
#declare G1 = fn_Gradient(F1) #declare G2 = fn_Gradient_Directional(F1, <1, 1, 0>) #declare G3 = fn_Divergence(F1, F2, F3)
Pr(G1(1, 2, 3)) Pr(G2(1, 2, 3)) Pr(G3(1, 2, 3)) Vec(vGradient(F1, W)) Vec(vCurl(F1, F2, F3, W)) Pr(Divergence(F1, F2, F3, W))
Pr(Gradient_Length(F1, W)) Pr(Gradient_Directional(F1, W, x + y)) SetGradientAccuracy(-0.1) Vec(vGradient(F3, W))
)";

const std::string transforms = R"(#include "transforms.inc"
#declare O = box { <-1, -2, -3>, <2, 4, 7> }
#declare S = spline { cubic_spline -1, <0, 0, 0> 0, <1, 0, 0.5> 1, <3, 1, 0> 2, <4, 3, 2> 3, <5, 1, 3> }
Trf(Shear_Trans(W, <0, 1, 1>, <1, 0, 2>)) Trf(Matrix_Trans(W, <0, 1, 1>, <1, 0, 2>, <7, 8, 9>)) Trf(Axial_Scale_Trans(W, 3))
Trf(Axis_Rotate_Trans(W, 40)) Trf(Rotate_Around_Trans(<10, 20, 30>, W)) Trf(Reorient_Trans(W, <3, 1, -1>))
Trf(Reorient_Trans(x, x)) Trf(Reorient_Trans(<1, 1, 1>, <2, 2, 2>)) Trf(Point_At_Trans(W)) Trf(Point_At_Trans(-y))
Trf(Center_Trans(O, x)) Trf(Center_Trans(O, x + z)) Trf(Align_Trans(O, x, <10, 11, 12>))
Trf(Align_Trans(O, z - y, <10, 11, 12>)) Trf(Align_Trans(O, -x, 5)) Trf(Spline_Trans(S, 0.7, y, 0.1, 0.5))
Vec(vtransform(W, transform { scale 2 translate x })) Vec(vinv_transform(W, transform { scale 2 translate x }))
)";

const std::string random = R"(#include "rand.inc"
#declare R = seed(5); #declare Ob = sphere { W, 2 } #declare Curve = spline { 0, <0, 0.2> 0.5, <0, 1> 1, <0, 0.1> }
#for (I, 1, 4)
    Pr(rand(RdmA)) Pr(rand(RdmB)) Pr(rand(RdmC)) Pr(rand(RdmD)) Pr(Prob(0.4, R)) Pr(Rand_Cauchy(1, 2, R))
    #declare Z = Rand_Student(5, R); Pr(Z) #declare Z = Rand_Normal(1, 2, R); Pr(Z) #declare Z = Rand_Gauss(1, 2, R); Pr(Z)
    #declare Z = Rand_Gamma(2.5, 1.5, R); Pr(Z) #declare Z = Rand_Gamma(1, 1.5, R); Pr(Z)
    #declare Z = Rand_Gamma(0.5, 1.5, R); Pr(Z) #declare Z = Rand_Beta(2, 3, R); Pr(Z) #declare Z = Rand_Spline(Curve, R); Pr(Z)
    #declare Z = Rand_Chi_Square(4, R); Pr(Z) #declare Z = Rand_F_Dist(3, 4, R); Pr(Z)
    #declare Z = Rand_Triangle(1, 5, 2, R); Pr(Z) #declare Z = Rand_Erlang(1, 3, R); Pr(Z) Pr(Rand_Exp(2, R))
    #declare Z = Rand_Lognormal(0, 1, R); Pr(Z) Pr(Rand_Pareto(2, R)) Pr(Rand_Weibull(1, 2, R)) Pr(Rand_Bernoulli(0.5, R))
    #declare Z = Rand_Binomial(9, 0.3, R); Pr(Z) Pr(Rand_Geo(0.3, R)) #declare Z = Rand_Poisson(3, R); Pr(Z)
    Pr(SRand(R)) Pr(RRand(2, 5, R)) Vec(VRand(R)) Vec(VRand_In_Box(W, <4, 6, 8>, R)) #declare Z = VRand_In_Sphere(R); Vec(Z)
    #declare Z = VRand_On_Sphere(R); Vec(Z) #declare Z = VRand_In_Obj(Ob, R); Vec(Z)
#end
)";

const std::string arrays = R"(#include "arrays.inc"
#declare R = seed(3); #declare A = array[5] {3, 1, 4, 1, 5} Resize_Array(A, 7) Pr(dimension_size(A, 1))
#ifdef (A[6]) Pr(1) #end Resize_Array(A, 4) Reverse_Array(A) #for (I, 0, 3) Pr(A[I]) #end
Resize_Array(A, 3) Reverse_Array(A) #for (I, 0, 2) Pr(A[I]) #end #for (I, 1, 5) Pr(Rand_Array_Item(A, R)) #end
#declare B = array[60]; #for (I, 0, 59) #declare B[I] = floor(rand(R) * 100); #end
Sort_Partial_Array(B, 10, 40) #for (I, 0, 59) Pr(B[I]) #end Sort_Array(B) #for (I, 0, 59) Pr(B[I]) #end
)";

const std::string strings = R"(#include "strings.inc"
#debug Str(pi) #debug VStr(W) #debug VStr2D(W) #debug Vstr(W, 8, 2) #debug Vstr2D(W, -8, 2) #debug CRGBStr(rgb W, 5, 2)
#debug CRGBFTStr(rgbft C5, 0, -1) #debug Triangle_Str(W, W * 2, x) #debug Smooth_Triangle_Str(W, x, W * 2, y, W * 3, z)
Parse_String("#declare Q = 3 * 4;") Pr(Q)
)";

const std::string functions = R"(#include "functions.inc"
Pr(f_sphere(1, 2, 3, 1)) Pr(f_snoise3d(0.1, 0.2, 0.3)) Pr(f_sine_wave(0.3, 2, 3)) Pr(f_scallop_wave(0.3, -2, 3))
Pr(f_dents(0.1, 0.2, 0.3)) Pr(f_torus(1, 2, 3, 1, 0.3)) Pr(f_helix1(1, 2, 3, 1, 2, 0.1, 1, 1, 0.5, 30)) Pr(f_spotted(1, 2, 0.5))
Five(eval_pigment(pigment { gradient x color_map { [0 rgb 0] [1 rgb <1, 0.5, 0.2>] } }, <0.3, 0, 0>))
)";

const std::string shapes = R"(#include "shapes.inc"
#macro Ask(O) #declare Thing = O
    Vec(min_extent(Thing)) Vec(max_extent(Thing))
    #for (I, 0, 4)
        #local N = <0, 0, 0>;
        #local H = trace(Thing, <5, 4, -6 + I>, <-5 + 0.1 * I, -4 + 0.3 * I, 6 - I>, N);
        #if (vlength(N) > 0) Vec(H) Vec(N) #else #debug "- " #end Pr(inside(Thing, <0.1 * I, 0.2 * I, 0.1>))
    #end
#end
Ask(Round_Box(<-1, -2, -1>, <1, 2, 3>, 0.3, no)) Ask(Round_Box_Merge(<1, 2, 3>, <-1, -2, -1>, 0.5)) Ask(Wire_Box_Union(W, -W, 0.2))
Ask(Round_Cylinder(<0, -1, 0>, <1, 1, 0>, 1, 0.2, no)) Ask(Round_Cylinder_Merge(-z, 2 * z, 0.5, 0.6)) Ask(Spheroid(x, W))
Ask(Round_Cone(-y, 1, y, 0.5, 0.1, no)) Ask(Round_Cone_Union(-y, 0.7, <0, 2, 0>, 1.5, 0.2)) Ask(Round_Cone2(-y, 1, y, 0.5, no))
Ask(Round_Cone3(-y, 1, y, 0.5, no)) Ask(Connect_Spheres(-x, 1, 2 * x, 0.5)) Ask(Wedge(70)) Ask(Wedge(180)) Ask(Wedge(250))
Ask(Center_Object(box { 0, W }, x + z)) Ask(Align_Object(box { 0, W }, x, <5, 5, 5>))
#declare P = <0, 0, 0>; #declare N = <0, 0, 0>; Pr(IsectN(-5 * z, z, sphere { 0, 1 }, P, N)) Vec(P) Vec(N)
Pr(Isect(-5 * z, y, sphere { 0, 1 }, P)) #declare Low = 0; #declare High = 0; Extents(box { 0, W }, Low, High) Vec(Low + High)
#declare Waves = function { 0.1 * sin(x * 5) * cos(z * 3) + 0.05 * y }
Ask(HF_Square(Waves, no, no, 9, yes, "", <-2, 0, -2>, <2, 1, 2>)) Ask(HF_Sphere(Waves, yes, yes, <12, 9>, yes, "", y, 1, 0.5))
Ask(HF_Cylinder(Waves, no, no, 10, no, "", -y, y, 1, 0.3)) Ask(HF_Torus(Waves, yes, no, <14, 9>, yes, "", 1.5, 0.4, 0.3))
Ask(Sphere) Ask(Cube) Ask(Disk_Y) Ask(Cone_Z)
)";

TEST(Include, OursDeclareAllThatPovRaysDeclare) {
    const auto folders = povray_folders();
    if (folders.empty()) GTEST_SKIP() << "skipped: no POV-Ray includes";
    for (const std::string& name : ours) {
        std::string text;
        for (const EmbeddedFile& file : embedded_files())
            if (file.name == name + ".inc") text = file.text;
        ASSERT_NE(text, "") << name;
        const std::set<std::string> here = declared_names(text);
        for (const std::string& word : declared_names(text_of(folders.front() / (name + ".inc")))) {
            const bool scratch =
                word == "ARRAYS_Temp" || word == "ARRAYS_Temp_WriteDF3"; // undefined again by the file
            EXPECT_TRUE(scratch || here.contains(word)) << name << ".inc has no " << word;
        }
    }
}

TEST(Include, OursPrintWhatPovRaysPrint) {
    const auto folders = povray_folders();
    if (folders.empty()) GTEST_SKIP() << "skipped: no POV-Ray includes";
    LoadOptions theirs;
    theirs.library = {folders.front()};
    for (const std::string& text : {math, transforms, random, arrays, strings, functions, shapes}) {
        const std::string printed = run(printers + text);
        EXPECT_GT(printed.size(), 100u) << text;
        std::string expected = run(printers + text, theirs);
        EXPECT_EQ(printed, expected);
    }
}

TEST(Include, NumbersThatPovRayPrints) { // for where it is not installed
    EXPECT_EQ(run("#include \"rand.inc\" #debug str(rand(RdmA), 0, 8)"), "0.28803607");
    EXPECT_EQ(run("#include \"math.inc\" #debug str(VRotation(<1, 2, 3>, <-2, 0.5, 1>, y), 0, 8)"),
              "-1.33534207");
    EXPECT_EQ(run("#include \"consts.inc\" #debug str(Flint_Glass_Ior + FoV_60, 0, 6)"), "3.442113");
    EXPECT_EQ(run("#include \"transforms.inc\" #debug vstr(3, vtransform(<1, 2, 3>, transform { scale 2 "
                  "translate x "
                  "}), \" \", 0, 1)"),
              "3.0 4.0 6.0");
}

TEST(Include, DensityFiles) {
    // The bytes are read back as text: 65 is A.
    EXPECT_EQ(run("#fopen F \"q.txt\" write #write (F, uint8 34, uint8 <65.4, 65.6>, uint16be 16963, "
                  "sint16le 17220, "
                  "uint8 34) #fclose F #fopen F \"q.txt\" read #read (F, T) #debug T"),
              "ABBCDC");
}

} // namespace
} // namespace pnr::test
