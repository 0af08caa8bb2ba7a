//! The linked shaders against what browsers demand; no device needed.

use std::path::{Path, PathBuf};

use genga_tests::scenes::root;
use naga::valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, Block, Expression, Module, SampleLevel, ShaderStage, Statement};

fn shaders() -> Vec<PathBuf> {
    let folder = root().join("crates/genga/src/render/generated");
    let files = std::fs::read_dir(&folder).expect("the linked shaders are in the repository");
    let mut shaders: Vec<PathBuf> = files
        .map(|file| file.expect("the folder can be listed").path())
        .filter(|path| path.extension().is_some_and(|e| e == "wgsl"))
        .collect();
    shaders.sort();
    assert!(shaders.len() >= 9, "only {} shaders in {}", shaders.len(), folder.display());
    shaders
}

fn validated(path: &Path) -> (Module, ModuleInfo) {
    let wgsl = std::fs::read_to_string(path).expect("a linked shader can be read");
    validated_text(&wgsl, &path.display().to_string())
}

fn validated_text(wgsl: &str, name: &str) -> (Module, ModuleInfo) {
    let module = naga::front::wgsl::parse_str(wgsl)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string_with_path(wgsl, name)));
    // pack2x16float is core WGSL; naga counts it as a capability.
    let core = Capabilities::SHADER_FLOAT16_IN_FLOAT32;
    let info = Validator::new(ValidationFlags::all(), core)
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string_with_path(wgsl, name)));
    (module, info)
}

#[test]
fn shaders_are_valid_without_any_capability() {
    for path in shaders() {
        let (module, _) = validated(&path);
        assert!(!module.entry_points.is_empty(), "{} has no entry point", path.display());
    }
}

#[test]
fn entry_points_keep_the_default_limits() {
    let limits = wgpu::Limits::default();
    for path in shaders() {
        let (module, info) = validated(&path);
        for (i, entry) in module.entry_points.iter().enumerate() {
            let what = format!("{} in {}", entry.name, path.display());
            let used = |space: fn(&AddressSpace) -> bool| {
                let info = info.get_entry_point(i);
                let globals = module.global_variables.iter();
                globals.filter(|(g, v)| space(&v.space) && !info[*g].is_empty()).count() as u32
            };
            let storage = used(|space| matches!(space, AddressSpace::Storage { .. }));
            assert!(storage <= limits.max_storage_buffers_per_shader_stage, "{what}: {storage}");
            let uniforms = used(|space| matches!(space, AddressSpace::Uniform));
            assert!(uniforms <= limits.max_uniform_buffers_per_shader_stage, "{what}: {uniforms}");
            if entry.stage == ShaderStage::Compute {
                let invocations: u32 = entry.workgroup_size.iter().product();
                assert!((1..=limits.max_compute_invocations_per_workgroup).contains(&invocations));
            }
        }
        for (_, global) in module.global_variables.iter() {
            let group = global.binding.map_or(0, |binding| binding.group);
            assert!(group < limits.max_bind_groups, "{}: group {group}", path.display());
        }
    }
}

/// Browsers reject derivatives and sampling with an implicit level in control flow that may
/// differ between neighbouring fragments; naga does not look. This is a stricter rule than
/// WGSL's: every local variable counts as different.
#[test]
fn derivatives_are_only_taken_in_uniform_control_flow() {
    let mut found = 0;
    for path in shaders() {
        let (module, info) = validated(&path);
        let mut walk = Walk { module: &module, info: &info, found: 0, faults: Vec::new() };
        walk.all();
        assert!(walk.faults.is_empty(), "{}: {:?}", path.display(), walk.faults);
        found += walk.found;
    }
    assert!(found >= 4, "only {found} derivatives and samples found: does the walk see them?");
}

#[test]
fn the_walk_finds_derivatives_under_conditions() {
    let bodies = [
        ("return fwidth(x);", true),
        ("if (x > 0.0) { discard; } return fwidth(x);", true),
        ("if (x > 0.0) { return fwidth(x); } return 0.0;", false),
        ("if (x > 0.0) { return 1.0; } return fwidth(x);", false),
        ("if (x > 0.0) { return slope(x); } return 0.0;", false),
        ("for (var i = 0; i < 3; i++) { if (x > f32(i)) { return 1.0; } } return slope(x);", false),
        ("var y = 0.0; for (var i = 0; i < 3; i++) { y += x; } return fwidth(y);", true),
    ];
    for (body, is_fine) in bodies {
        let wgsl = format!(
            "fn slope(x: f32) -> f32 {{ return fwidth(x); }}
             @fragment fn f(@location(0) x: f32) -> @location(0) f32 {{ {body} }}"
        );
        let (module, info) = validated_text(&wgsl, body);
        let mut walk = Walk { module: &module, info: &info, found: 0, faults: Vec::new() };
        walk.all();
        assert_eq!(walk.faults.is_empty(), is_fine, "{body}: {:?}", walk.faults);
    }
}

/// Follows the control flow of a module's functions.
struct Walk<'a> {
    module: &'a Module,
    info: &'a ModuleInfo,
    found: usize,
    faults: Vec<String>,
}

/// What has happened on the way to a statement.
#[derive(Clone, Copy, Default)]
struct Flow {
    /// Neighbouring fragments may not all be here.
    differs: bool,
    /// Some may have returned.
    returned: bool,
}

impl Walk<'_> {
    fn all(&mut self) {
        for (handle, function) in self.module.functions.iter() {
            let name = function.name.clone().unwrap_or_default();
            self.block(&function.body, function, &self.info[handle], &name, Flow::default());
        }
        for (i, entry) in self.module.entry_points.iter().enumerate() {
            if entry.stage == ShaderStage::Fragment {
                let (function, info) = (&entry.function, self.info.get_entry_point(i));
                self.block(&function.body, function, info, &entry.name, Flow::default());
            }
        }
    }

    /// Whether a function takes derivatives, itself or in what it calls.
    fn takes_derivatives(&self, function: &naga::Function) -> bool {
        let mut takes = function.expressions.iter().any(|(_, e)| needs_neighbours(e));
        visit(&function.body, &mut |statement| {
            if let Statement::Call { function, .. } = statement {
                takes |= self.takes_derivatives(&self.module.functions[*function]);
            }
        });
        takes
    }

    /// Returns whether some fragments may have returned in this block.
    fn block(
        &mut self,
        block: &Block,
        function: &naga::Function,
        info: &FunctionInfo,
        name: &str,
        mut flow: Flow,
    ) -> bool {
        let is_different =
            |e: naga::Handle<Expression>| info[e].uniformity.non_uniform_result.is_some();
        for statement in block {
            let differs = flow.differs || flow.returned;
            match statement {
                Statement::Emit(range) => {
                    for expression in range.clone() {
                        if needs_neighbours(&function.expressions[expression]) {
                            self.found += 1;
                            if differs {
                                self.faults.push(format!("in {name}"));
                            }
                        }
                    }
                }
                Statement::Call { function: called, .. } => {
                    let called = &self.module.functions[*called];
                    if differs && self.takes_derivatives(called) {
                        self.faults.push(format!("in {name}, which calls {:?}", called.name));
                    }
                }
                Statement::Block(inner) => {
                    flow.returned |= self.block(inner, function, info, name, flow);
                }
                Statement::If { condition, accept, reject } => {
                    let inner = Flow { differs: differs || is_different(*condition), ..flow };
                    let accepted = self.block(accept, function, info, name, inner);
                    let rejected = self.block(reject, function, info, name, inner);
                    flow.returned |= inner.differs && (accepted || rejected);
                }
                Statement::Switch { selector, cases } => {
                    let inner = Flow { differs: differs || is_different(*selector), ..flow };
                    for case in cases {
                        let returned = self.block(&case.body, function, info, name, inner);
                        flow.returned |= inner.differs && returned;
                    }
                }
                Statement::Loop { body, continuing, .. } => {
                    // How often it runs is taken to differ.
                    let inner = Flow { differs: true, ..flow };
                    flow.returned |= self.block(body, function, info, name, inner);
                    flow.returned |= self.block(continuing, function, info, name, inner);
                }
                Statement::Return { .. } => return true,
                _ => {}
            }
        }
        flow.returned
    }
}

fn needs_neighbours(expression: &Expression) -> bool {
    match expression {
        Expression::Derivative { .. } => true,
        Expression::ImageSample { level, .. } => {
            matches!(level, SampleLevel::Auto | SampleLevel::Bias(_))
        }
        _ => false,
    }
}

/// Calls `see` with every statement of a block, however deep.
fn visit(block: &Block, see: &mut dyn FnMut(&Statement)) {
    for statement in block {
        see(statement);
        match statement {
            Statement::Block(inner) => visit(inner, see),
            Statement::If { accept, reject, .. } => {
                visit(accept, see);
                visit(reject, see);
            }
            Statement::Switch { cases, .. } => cases.iter().for_each(|case| visit(&case.body, see)),
            Statement::Loop { body, continuing, .. } => {
                visit(body, see);
                visit(continuing, see);
            }
            _ => {}
        }
    }
}
