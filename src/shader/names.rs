//! Names that a shader can use: those in its files, and those of GLSL.

use super::macros::Line;
use std::collections::BTreeSet;

const TYPES: &str = "bool int uint float vec2 vec3 vec4 ivec2 ivec3 ivec4 uvec2 uvec3 uvec4 \
    bvec2 bvec3 bvec4 mat2 mat3 mat4 mat2x3 mat2x4 mat3x2 mat3x4 mat4x2 mat4x3";

const FUNCTIONS: &str = "radians degrees sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh \
    pow exp log exp2 log2 sqrt inversesqrt abs sign floor trunc round roundEven ceil fract mod modf \
    min max clamp mix step smoothstep isnan isinf floatBitsToInt floatBitsToUint intBitsToFloat \
    uintBitsToFloat fma frexp ldexp packUnorm2x16 packSnorm2x16 packUnorm4x8 packSnorm4x8 \
    unpackUnorm2x16 unpackSnorm2x16 unpackUnorm4x8 unpackSnorm4x8 packHalf2x16 unpackHalf2x16 \
    packDouble2x32 unpackDouble2x32 length distance dot cross normalize faceforward reflect refract \
    matrixCompMult outerProduct transpose determinant inverse lessThan lessThanEqual greaterThan \
    greaterThanEqual equal notEqual any all not uaddCarry usubBorrow umulExtended imulExtended \
    bitfieldExtract bitfieldInsert bitfieldReverse bitCount findLSB findMSB textureSize \
    textureQueryLod textureQueryLevels textureSamples texture textureProj textureLod textureOffset \
    texelFetch texelFetchOffset textureGrad textureGather textureGatherOffset atomicAdd atomicMin \
    atomicMax atomicAnd atomicOr atomicXor atomicExchange atomicCompSwap imageSize imageSamples \
    imageLoad imageStore imageAtomicAdd imageAtomicMin imageAtomicMax imageAtomicAnd imageAtomicOr \
    imageAtomicXor imageAtomicExchange imageAtomicCompSwap dFdx dFdy dFdxFine dFdyFine dFdxCoarse \
    dFdyCoarse fwidth interpolateAtCentroid interpolateAtSample interpolateAtOffset EmitVertex \
    EndPrimitive barrier memoryBarrier memoryBarrierBuffer memoryBarrierShared memoryBarrierImage \
    groupMemoryBarrier subpassLoad subgroupBarrier subgroupElect subgroupAll subgroupAny \
    subgroupBallot subgroupBallotBitCount subgroupBroadcast subgroupBroadcastFirst subgroupAdd \
    subgroupMin subgroupMax subgroupExclusiveAdd subgroupInclusiveAdd subgroupShuffle";

const VARIABLES: &str = "gl_VertexIndex gl_InstanceIndex gl_Position gl_PointSize gl_InvocationID \
    gl_PrimitiveID gl_PrimitiveIDIn gl_TessLevelOuter gl_TessLevelInner gl_TessCoord gl_in gl_out \
    gl_PatchVerticesIn gl_Layer gl_ViewportIndex gl_FragCoord gl_FrontFacing gl_PointCoord \
    gl_FragDepth gl_SampleID gl_SampleMask gl_HelperInvocation gl_NumWorkGroups gl_WorkGroupSize \
    gl_WorkGroupID gl_LocalInvocationID gl_GlobalInvocationID gl_LocalInvocationIndex \
    gl_SubgroupSize gl_SubgroupInvocationID gl_SubgroupID gl_NumSubgroups";

/// Names by their use.
pub(super) struct Names<'t> {
    /// Functions, constructors and macros with arguments.
    pub functions: BTreeSet<&'t str>,
    /// Variables, parameters of functions, members of blocks, and macros.
    pub variables: BTreeSet<&'t str>,
}

/// Names that the files of a shader declare, and those of GLSL.
pub(super) fn names<'l, 't: 'l>(lines: impl Iterator<Item = &'l Line<'t>>) -> Names<'t> {
    let mut names = Names {
        functions: TYPES.split(' ').chain(FUNCTIONS.split(' ')).collect(),
        variables: VARIABLES.split(' ').collect(),
    };
    for line in lines {
        if !matches!(line.directive(), None | Some("define")) {
            continue;
        }
        let token = |i: usize| line.tokens.get(i).copied().unwrap_or_default();
        for (i, name) in line.tokens.iter().enumerate().filter(|t| is_word(t.1)) {
            let before = i.checked_sub(1).map_or("", token);
            let is_after_type = match before {
                "return" | "else" | "case" => false,
                "]" | "}" => true,
                word => is_word(word),
            };
            match token(i + 1) {
                "(" if is_after_type => names.functions.insert(name),
                "{" if before == "struct" => names.functions.insert(name),
                _ if before == "define" => names.variables.insert(name),
                "{" | "(" => false,
                next if is_word(next) => false,
                // Variables of one type are separated by commas.
                _ => (is_after_type || before == ",") && names.variables.insert(name),
            };
        }
    }
    names
}

fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}
