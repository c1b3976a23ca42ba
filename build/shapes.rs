//! The kinds of `src/schema/shapes.rs` → GLSL: the file of each kind, and macros that go through all kinds or through
//! those of a property. They hand on the kind's record, the function that reads one by its index, the constant with the
//! length of the list, how many shapes come before and belong to it, and whether it is planar, polygonal, listed and
//! concave.

use crate::shapes::with_shapes;
use crate::tables::ShapeKind;

with_shapes!(shape_kinds);

pub fn shapes() -> String {
    let mut text = String::from("// The kinds of shapes; each file says what one answers.\n");
    for kind in SHAPE_KINDS {
        text += &format!("#include \"geometry/{}.glsl\"\n", kind.module);
    }
    text += "\n#define COUNT_SHAPES";
    for kind in SHAPE_KINDS {
        let (list, length) = (kind.list, kind.list.to_uppercase());
        text += &format!(" \\\n    uint {list} = COUNT({length}, lengths.{list});");
    }
    let sum = |kinds: &[ShapeKind]| kinds.iter().map(|kind| kind.list).collect::<Vec<_>>().join(" + ");
    text += &format!(" \\\n    uint shapes = {};\n\n", sum(SHAPE_KINDS));
    let with = |property: &'static str| move |kind: &ShapeKind| kind.properties.contains(&property);
    let without = |property: &'static str| move |kind: &ShapeKind| !kind.properties.contains(&property);
    let before = |at: usize| if at == 0 { "0u".to_owned() } else { sum(&SHAPE_KINDS[..at]) };
    let through = |name: &str, chosen: &dyn Fn(&ShapeKind) -> bool| {
        let mut text = format!("#define {name}(DO)");
        for (at, kind) in SHAPE_KINDS.iter().enumerate().filter(|(_, kind)| chosen(kind)) {
            let (list, length) = (kind.list, kind.list.to_uppercase());
            let flags = ["planar", "polygonal", "listed", "concave"]
                .map(|property| with(property)(kind).to_string())
                .join(", ");
            let (record, first) = (kind.record, before(at));
            text += &format!(" \\\n    DO({record}, {}_at, {length}, {first}, {list}, {flags})", kind.module);
        }
        text + "\n"
    };
    text += &through("SHAPE_KINDS", &|_| true);
    text += &through("PLANAR_KINDS", &with("planar"));
    text += &through("SOLID_KINDS", &without("planar"));
    text += &through("POLYGONAL_KINDS", &with("polygonal"));
    text += &through("ROUND_KINDS", &without("polygonal"));
    text += &through("CONCAVE_KINDS", &with("concave"));
    let some = |property| {
        let kinds = SHAPE_KINDS.iter().filter(|kind| with(property)(kind));
        let lengths: Vec<_> = kinds.map(|kind| kind.list.to_uppercase()).collect();
        format!("const bool {}_SHAPES = ({}) != 0u;\n", property.to_uppercase(), lengths.join(" | "))
    };
    text + "\n// Some shape may have a normal that changes, or be met again by a ray that leaves it.\n"
        + &some("curved")
        + &some("concave")
}
