fn main() {
    let c = shaderc::Compiler::new().unwrap();
    let a = c
        .compile_into_spirv(
            "#version 460\nlayout(local_size_x=1) in; void main(){}",
            shaderc::ShaderKind::Compute,
            "x",
            "main",
            None,
        )
        .unwrap();
    assert!(a.len() > 0);
}
