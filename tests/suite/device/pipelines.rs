//! Pipelines that a device keeps: an equal description gets the same one, any other its own, and those that nobody asked
//! for in a long time go.

use std::sync::Arc;

use moire::internal::gpu::shaders::{MIPS, Shader};
use moire::internal::gpu::{BindingDesc, Pipeline};
use moire::internal::schema::specialization::Constant;

use super::Checked;

fn of(gpu: &Checked, shader: &'static Shader, group: u32) -> Arc<Pipeline> {
    with(gpu, shader, &shader.values([(Constant::GroupX, group), (Constant::GroupY, 1)]))
}

fn with(gpu: &Checked, shader: &'static Shader, constants: &[(u32, u32)]) -> Arc<Pipeline> {
    let bindings: Vec<BindingDesc> =
        shader.bindings.iter().map(|b| BindingDesc { binding: b.binding, kind: b.kind, count: 1 }).collect();
    gpu.shader_pipeline(shader, &bindings, 32, constants).unwrap()
}

#[test]
fn equal_pipelines_are_built_once_and_others_are_others() {
    let gpu = Checked::open();
    let first = of(&gpu, &MIPS, 64);
    assert!(Arc::ptr_eq(&first, &of(&gpu, &MIPS, 64)));
    let other = of(&gpu, &MIPS, 32);
    assert!(!Arc::ptr_eq(&first, &other));
    assert!(Arc::ptr_eq(&first, &of(&gpu, &MIPS, 64)) && Arc::ptr_eq(&other, &of(&gpu, &MIPS, 32)));
    // Another device has its own.
    assert!(!Arc::ptr_eq(&first, &of(&Checked::open(), &MIPS, 64)));
}

#[test]
fn the_order_of_constants_makes_no_other_pipeline() {
    let gpu = Checked::open();
    let values = [(Constant::GroupX, 64), (Constant::GroupY, 1), (Constant::MipChannels, 1)];
    let mut constants = MIPS.values(values);
    let first = with(&gpu, &MIPS, &constants);
    constants.reverse();
    assert!(constants.len() > 1 && Arc::ptr_eq(&first, &with(&gpu, &MIPS, &constants)));
}

#[test]
fn pipelines_that_nobody_asks_for_are_given_up() {
    let gpu = Checked::open();
    let (old, used) = (of(&gpu, &MIPS, 1), of(&gpu, &MIPS, 2));
    for group in 3..64 {
        of(&gpu, &MIPS, group);
        assert!(Arc::ptr_eq(&used, &of(&gpu, &MIPS, 2)), "group {group}");
    }
    assert!(!Arc::ptr_eq(&old, &of(&gpu, &MIPS, 1)));
    assert_eq!(Arc::strong_count(&old), 1);
}
