"""Texts of panels in other languages; missing ones stay English."""

import bpy

LANGUAGES = ("ja_JP", "zh_HANS", "fr_FR", "es")
TEXTS = {
    "Import": ("インポート", "导入", "Importer", "Importar"),
    "Import Motion Capture": (
        "モーションキャプチャをインポート", "导入动作捕捉", "Importer la capture de mouvement",
        "Importar captura de movimiento",
    ),
    "Clean": ("クリーン", "清理", "Nettoyer", "Limpiar"),
    "Check": ("チェック", "检查", "Vérifier", "Comprobar"),
    "Compare": ("比較", "比较", "Comparer", "Comparar"),
    "Feet": ("足", "脚", "Pieds", "Pies"),
    "Bones": ("ボーン", "骨骼", "Os", "Huesos"),
    "Motion Model": (
        "モーションモデル", "运动模型", "Modèle de mouvement", "Modelo de movimiento",
    ),
    "From This Take": (
        "このテイクから", "来自此次录制", "De cette prise", "De esta toma",
    ),
    "From Examples": ("お手本から", "来自示例", "Des exemples", "De ejemplos"),
    "Learned File": ("学習済みファイル", "学习文件", "Fichier appris", "Archivo aprendido"),
    "Add Example": ("お手本を追加", "添加示例", "Ajouter un exemple", "Añadir ejemplo"),
    "Strength": ("強さ", "强度", "Force", "Intensidad"),
    "Frame Range": ("フレーム範囲", "帧范围", "Plage d’images", "Rango de fotogramas"),
    "Joint Limits": ("関節の制限", "关节限制", "Limites d’articulation", "Límites articulares"),
    "Output": ("出力", "输出", "Sortie", "Salida"),
    "Plant Feet": ("足を固定", "固定脚", "Ancrer les pieds", "Fijar los pies"),
    "Advanced": ("詳細設定", "高级", "Avancé", "Avanzado"),
    "Thresholds": ("しきい値", "阈值", "Seuils", "Umbrales"),
    "Esc cancels": ("Escで中止", "按 Esc 取消", "Échap annule", "Esc cancela"),
    "Before": ("前", "之前", "Avant", "Antes"),
    "After": ("後", "之后", "Après", "Después"),
    "Jitter (°)": ("揺れ (°)", "抖动 (°)", "Tremblement (°)", "Temblor (°)"),
    "Jitter (mm)": ("揺れ (mm)", "抖动 (mm)", "Tremblement (mm)", "Temblor (mm)"),
    "Spikes": ("スパイク", "尖峰", "Pics", "Picos"),
    "Missing (%)": ("欠損 (%)", "缺失 (%)", "Manquant (%)", "Ausente (%)"),
    "Longest Slide (cm)": (
        "最大の滑り (cm)", "最长滑动 (cm)", "Glissement max. (cm)", "Deslizamiento máx. (cm)",
    ),
    "Previous": ("前へ", "上一个", "Précédent", "Anterior"),
    "Next": ("次へ", "下一个", "Suivant", "Siguiente"),
    "Raw": ("元データ", "原始", "Brut", "Original"),
    "Compare Overlay": (
        "元と結果を重ねて表示", "叠加显示原始与结果", "Superposer brut et nettoyé",
        "Superponer original y limpio",
    ),
    "Made from {raw}": ("{raw} から作成", "由 {raw} 生成", "Issu de {raw}", "Hecho de {raw}"),
    "Revert to Raw": ("元に戻す", "恢复原始", "Revenir au brut", "Volver al original"),
    "Left Foot Contact": (
        "左足が接地", "左脚着地", "Pied gauche posé", "Pie izquierdo apoyado",
    ),
    "Right Foot Contact": ("右足が接地", "右脚着地", "Pied droit posé", "Pie derecho apoyado"),
    "Reconstruct": ("再構成", "重建", "Reconstruire", "Reconstruir"),
    "Poses": ("ポーズ", "姿势", "Poses", "Poses"),
    "Show Confidence": (
        "信頼度を表示", "显示置信度", "Afficher la confiance", "Mostrar confianza",
    ),
    "Retarget": ("リターゲット", "重定向", "Reciblage", "Redirigir"),
    "Find Bones": ("ボーンを探す", "查找骨骼", "Trouver les os", "Buscar huesos"),
    "Unbake": ("キーを間引く", "精简关键帧", "Alléger les clés", "Reducir claves"),
    "Target": ("ターゲット", "目标", "Cible", "Destino"),
    "Source Action": ("ソースのアクション", "源动作", "Action source", "Acción de origen"),
    "Root Motion": ("ルートモーション", "根运动", "Mouvement racine", "Movimiento raíz"),
    "Match Foot Contacts": (
        "足の接地を合わせる", "匹配脚部接触", "Respecter les appuis", "Ajustar los apoyos",
    ),
    "Match Hand Reach": (
        "手の届く範囲を合わせる", "匹配手部触及", "Respecter la portée des mains",
        "Ajustar el alcance de las manos",
    ),
    "Tolerance": ("許容誤差", "容差", "Tolérance", "Tolerancia"),
}  # fmt: skip
CONTEXTS = ("*", "Operator")  # labels and properties, buttons


def dictionary() -> dict[str, dict[tuple[str, str], str]]:
    """Return the texts as Blender wants them: by language, then by context and English."""
    return {
        language: {
            (context, english): texts[column]
            for english, texts in TEXTS.items()
            for context in CONTEXTS
        }
        for column, language in enumerate(LANGUAGES)
    }


def register() -> None:
    """Let Blender translate."""
    bpy.app.translations.register(__package__, dictionary())


def unregister() -> None:
    """Forget the translations."""
    bpy.app.translations.unregister(__package__)
